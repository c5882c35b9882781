// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "components/perception/node/node.hpp"
#include "libs/dds/camera_publisher.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/perception/node/scripted_perception.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::perception {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

inline rgbd::RgbdCamera SmallCamera() {
  rgbd::RgbdCamera camera;
  camera.depth = {4, 3, 5.0, 5.0, 1.5, 1.0, {}};
  camera.color = camera.depth;
  camera.color_registered = true;
  return camera;
}

inline NodeConfig TestConfig() {
  NodeConfig config;
  config.pairing_wait_s = 2.0;  // a loaded machine sends the parts of a frame far apart
  return config;
}

/// The node in a thread of its own, and a participant that plays camera, estimator and reader.
class PerceptionNodeTest : public testing::Test {
 protected:
  struct Answer {
    std::int64_t stamp_ns = 0;
    std::uint64_t counter = 0;
    std::string status;
    std::string reason;
    std::int64_t prediction_ns = 0;
    double age_s = 0.0;
    double latency_s = 0.0;
    geometry::DepthPicture picture;
    std::vector<std::string> notes;
  };

  explicit PerceptionNodeTest()
      : test_("test", ManyImages()),
        camera_(test_.participant, test_.Waker()),
        meshes_(test_.participant.CreateWriter(dds::kMeshTopic)),
        mesh_states_(test_.participant.CreateWriter(dds::kMeshStateTopic, test_.Waker())),
        reports_(test_.participant.CreateReader(dds::kPerceptionReportTopic, test_.Waker())),
        contacts_(test_.participant.CreateReader(dds::kContactsTopic, test_.Waker())),
        robots_(test_.participant.CreateReader(dds::kRobotCloudTopic, test_.Waker())),
        objects_(test_.participant.CreateReader(dds::kObjectCloudTopic, test_.Waker())),
        health_(test_.participant.CreateReader(dds::kComponentStatusTopic)) {
    test_.loop.Attach(reports_, [this] { TakeReports(); });
    test_.loop.Attach(health_, [this] {
      for (const auto& message : health_.Take()) received_ = message.received;
    });
  }
  ~PerceptionNodeTest() override {
    if (!node_) return;
    script_.Hold(false);
    node_->Stop();
    thread_.join();
  }

  void StartNode(const NodeConfig& config, bool with_pose = true,
                 FramePerceptionMaker maker = nullptr) {
    std::optional<Eigen::Isometry3d> pose;
    if (with_pose) pose = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.5));
    if (!maker) maker = script_.Maker();
    node_ = std::make_unique<PerceptionNode>(config, pose, std::move(maker),
                                             static_cast<int>(dds::TestDomain()), ManyImages(),
                                             dds::NodeLog::ProcessLog());
    thread_ = std::thread([this] { node_->Run(); });
    ASSERT_TRUE(test_.WaitFor([this] {
      return camera_.is_read() && mesh_states_.matched() == 1 && reports_.matched() == 1 &&
             contacts_.matched() == 1 && robots_.matched() == 1 && objects_.matched() == 1;
    }));
  }

  /// Images wait for slow readers, so that tests see what the node does, not what DDS drops.
  static dds::TopicTable ManyImages() {
    std::vector<dds::TopicSettings> topics = dds::BuiltInTable().topics();
    for (dds::TopicSettings& topic : topics) {
      if (topic.name.ends_with("/image_raw")) topic.depth = 32;
    }
    return dds::TopicTable(std::move(topics));
  }

  void SendCamera(const rgbd::RgbdCamera& camera, std::uint32_t epoch, std::int64_t stamp_ns,
                  const std::string& device = "Palpate-1", double sigma_px = 0.0) {
    epoch_ = epoch;
    ASSERT_TRUE(camera_.PublishCamera(camera, {device, "model", epoch, sigma_px}, stamp_ns));
  }

  void SendFrame(std::int64_t stamp_ns, const rgbd::RgbdFrame& images,
                 const rgbd::RgbdCamera& camera = SmallCamera()) {
    dds::Message<idl::palpate_msgs::FrameInfo> info;
    dds::SetHeader(info->header, stamp_ns, "camera_depth_optical_frame");
    info->counter = counter_++;
    info->epoch = epoch_;
    ASSERT_TRUE(camera_.PublishFrame(camera, images, stamp_ns, *info));
  }
  void SendFrame(std::int64_t stamp_ns) { SendFrame(stamp_ns, Images()); }

  static rgbd::RgbdFrame Images(std::uint16_t depth = 400) {
    rgbd::RgbdFrame images;
    images.depth = rgbd::DepthImage(4, 3, depth);
    images.color = rgbd::ColorImage(4, 3, 7);
    return images;
  }

  /// Sends a frame and waits for its report.
  Answer Ask(std::int64_t stamp_ns, const rgbd::RgbdFrame& images) {
    SendFrame(stamp_ns, images);
    EXPECT_TRUE(WaitForAnswer(stamp_ns)) << stamp_ns;
    return answers_.empty() ? Answer{} : answers_.back();
  }
  Answer Ask(std::int64_t stamp_ns) { return Ask(stamp_ns, Images()); }
  bool WaitForAnswer(std::int64_t stamp_ns) {
    return test_.WaitFor([&] { return !answers_.empty() && answers_.back().stamp_ns == stamp_ns; });
  }

  /// A mesh of one triangle; its states have their first node at z = `z_m` in the robot's frame.
  void SendMesh() {
    const Eigen::Matrix3Xd nodes_m = Eigen::Matrix3Xd::Identity(3, 3);
    ASSERT_TRUE(meshes_.Write(dds::ToMesh(
        {"robot", "hash", nodes_m, Eigen::MatrixXi(4, 0), Eigen::Vector3i(0, 1, 2)}, 0)));
  }
  void SendMeshState(std::int64_t stamp_ns, double z_m) {
    Eigen::VectorXd x_m = Eigen::VectorXd::Zero(9);
    x_m[2] = z_m;
    ASSERT_TRUE(mesh_states_.Write(dds::ToMeshState(x_m, "hash", stamp_ns)));
    ASSERT_TRUE(mesh_states_.WaitUntilReceived(std::chrono::seconds(5)));
  }

  void TakeReports() {
    for (const auto& message : reports_.Take()) {
      answers_.push_back({dds::StampNs(message.header.stamp),
                          message.counter,
                          std::string(dds::Text(message.status)),
                          std::string(dds::Text(message.reason)),
                          dds::StampNs(message.prediction_stamp),
                          message.age_s,
                          message.latency_s,
                          dds::ToPicture(message.picture),
                          {}});
      for (const char* note : dds::Elements(message.notes)) {
        answers_.back().notes.emplace_back(dds::Text(note));
      }
    }
  }

  Script script_;
  dds::TestNode test_;
  dds::CameraPublisher camera_;
  dds::Writer<idl::palpate_msgs::Mesh> meshes_;
  dds::Writer<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Reader<idl::palpate_msgs::ContactArray> contacts_;
  dds::Reader<idl::sensor_msgs::PointCloud2> robots_;
  dds::Reader<idl::sensor_msgs::PointCloud2> objects_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> health_;
  std::uint32_t epoch_ = 0;
  std::uint64_t counter_ = 0;
  std::uint64_t received_ = 0;  ///< by the node, as it says once a second
  std::vector<Answer> answers_;
  std::unique_ptr<PerceptionNode> node_;
  std::thread thread_;
};

}  // namespace palpate::perception
