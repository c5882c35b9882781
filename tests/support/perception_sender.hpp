// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::test_support {

/// What perception publishes of a frame, as a test wants it.
struct SeenFrame {
  std::int64_t stamp_ns = 0;
  Eigen::Index points = 1;
  std::string device = "Palpate-1";
  std::uint32_t epoch = 1;
  std::string status = "ok";
  std::uint32_t contacts = 0;  ///< that the report counts
  double contact_x_m = 0.1;    ///< of the one in the list of contacts
  geometry::DepthPicture picture = {};
};

/// Plays palpate-perception and a robot with one cable, "top".
class PerceptionSender {
 public:
  static constexpr auto kFrame = "camera_depth_optical_frame";

  explicit PerceptionSender(dds::TestNode& test)
      : clouds_(test.participant.CreateWriter(dds::kRobotCloudTopic, test.Waker())),
        reports_(test.participant.CreateWriter(dds::kPerceptionReportTopic, test.Waker())),
        contacts_(test.participant.CreateWriter(dds::kContactsTopic, test.Waker())),
        joint_states_(test.participant.CreateWriter(dds::kJointStatesTopic, test.Waker())) {}

  /// `reads_contacts`: whether the node under test asks for them.
  bool IsMatched(bool reads_contacts) const {
    return clouds_.matched() == 1 && reports_.matched() == 1 && joint_states_.matched() == 1 &&
           contacts_.matched() == (reads_contacts ? 1u : 0u);
  }

  void SendCable(std::int64_t stamp_ns, double displacement_m, const std::string& cable = "top") {
    dds::Message<idl::sensor_msgs::JointState> message;
    dds::SetHeader(message->header, stamp_ns, "robot");
    dds::Resize(message->name, 1);
    dds::SetText(message->name._buffer[0], cable);
    dds::SetNumbers(message->position, &displacement_m, 1);
    ASSERT_TRUE(joint_states_.Write(message));
  }
  void SendCloud(const SeenFrame& seen) {
    rgbd::SensedCloud cloud;
    cloud.points_m = Eigen::Matrix3Xf::Constant(3, seen.points, 0.25f);
    cloud.sigma_m = Eigen::VectorXf::Ones(seen.points);
    cloud.colors_rgb.assign(static_cast<std::size_t>(3 * seen.points), 9);
    ASSERT_TRUE(clouds_.Write(dds::ToPointCloud2(cloud, seen.stamp_ns, kFrame)));
  }
  void SendReport(const SeenFrame& seen) {
    dds::Message<idl::palpate_msgs::PerceptionReport> report;
    dds::SetHeader(report->header, seen.stamp_ns, kFrame);
    report->epoch = seen.epoch;
    report->frame_counter = 77;
    report->contacts = seen.contacts;
    dds::SetPicture(report->picture, seen.picture);
    dds::SetText(report->device, seen.device);
    dds::SetText(report->status, seen.status);
    dds::SetText(report->reason, "as perception says");
    ASSERT_TRUE(reports_.Write(report));
  }
  void SendContacts(const SeenFrame& seen) {
    dds::Message<idl::palpate_msgs::ContactArray> contacts;
    dds::SetHeader(contacts->header, seen.stamp_ns, kFrame);
    dds::Resize(contacts->contacts, 1);
    auto& contact = contacts->contacts._buffer[0];
    dds::SetText(contact.name, "contact_1");
    contact.position_m = {seen.contact_x_m, 0.2, 0.3};
    contact.position_covariance_m2[1] = contact.position_covariance_m2[3] = 2e-6;
    contact.extent_m = {0.01, 0.02, 0.03};
    contact.point_count = 5;
    ASSERT_TRUE(contacts_.Write(contacts));
  }
  void Send(const SeenFrame& seen) {
    SendCloud(seen);
    SendReport(seen);
    SendContacts(seen);
  }

 private:
  dds::Writer<idl::sensor_msgs::PointCloud2> clouds_;
  dds::Writer<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Writer<idl::palpate_msgs::ContactArray> contacts_;
  dds::Writer<idl::sensor_msgs::JointState> joint_states_;
};

}  // namespace palpate::test_support
