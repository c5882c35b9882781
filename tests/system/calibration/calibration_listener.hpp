// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "libs/dds/geometry_messages.hpp"
#include "libs/geometry/rigid_registration.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::system_test {

inline constexpr std::chrono::seconds kPatience{100};

struct Told {
  std::string id, state, reason;
  std::uint32_t taken = 0;
};

struct Found {
  Eigen::Isometry3d T_robot_camera;
  Eigen::Matrix<double, 6, 6> covariance;  ///< shift, then turn
  std::string hash;
};

/// Hears palpate-calibration and asks it, and hears what others make of its answer.
class Listener {
 public:
  Listener()
      : node_("calibration_listener"),
        requests_(node_.participant.CreateWriter(dds::kCalibrationRequestTopic, node_.Waker())),
        statuses_(node_.participant.CreateReader(dds::kCalibrationStatusTopic)),
        calibrations_(node_.participant.CreateReader(dds::kCalibrationTopic)),
        forces_(node_.participant.CreateReader(dds::kForcesTopic)) {
    node_.loop.Attach(statuses_, [this] {
      for (const auto& message : statuses_.Take()) {
        told.push_back({std::string(dds::Text(message.request_id)),
                        std::string(dds::Text(message.state)),
                        std::string(dds::Text(message.reason)), message.frames_taken});
      }
    });
    node_.loop.Attach(calibrations_, [this] {
      for (const auto& message : calibrations_.Take()) Take(message);
    });
    node_.loop.Attach(forces_, [this] {
      for (const auto& message : forces_.Take()) force_status = dds::Text(message.status);
    });
  }

  void Ask(const std::string& id, std::uint32_t frames) {
    dds::Message<idl::palpate_msgs::CalibrationRequest> message;
    dds::SetText(message->id, id);
    message->frame_count = frames;
    ASSERT_TRUE(requests_.Write(message));
  }
  const Told* Find(const std::string& id, const std::string& state) const {
    for (const Told& one : told) {
      if (one.id == id && one.state == state) return &one;
    }
    return nullptr;
  }
  bool WaitForState(const std::string& id, const std::string& state) {
    return WaitFor([&] { return Find(id, state) || Find(id, "failed"); }) && Find(id, state);
  }
  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return node_.loop.DispatchUntil(condition, dds::WaitSet::Clock::now() + kPatience);
  }
  std::string Story() const {
    std::string story;
    for (const Told& one : told) {
      story += one.id + " " + one.state + " " + std::to_string(one.taken) + " " + one.reason + "\n";
    }
    return story;
  }

  std::vector<Told> told;
  std::vector<Found> found;
  std::string force_status;

 private:
  void Take(const idl::palpate_msgs::Calibration& message) {
    Found& one = found.emplace_back();
    EXPECT_TRUE(message.has_camera);
    EXPECT_TRUE(dds::FromPose(message.camera_in_robot, &one.T_robot_camera));
    one.covariance =
        Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.camera_covariance);
    one.hash = dds::Text(message.data_hash);
  }

  dds::TestNode node_;
  dds::Writer<idl::palpate_msgs::CalibrationRequest> requests_;
  dds::Reader<idl::palpate_msgs::CalibrationStatus> statuses_;
  dds::Reader<idl::palpate_msgs::Calibration> calibrations_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
};

/// The covariance of where a point of the robot comes to lie, `seen_m` from the camera's origin
/// (robot frame): errors of turn and shift make up for each other there.
inline Eigen::Matrix3d CovarianceOfPoint(const Found& found, const Eigen::Vector3d& seen_m) {
  Eigen::Matrix<double, 3, 6> change;
  change << Eigen::Matrix3d::Identity(), -geometry::CrossMatrix(seen_m);
  return change * found.covariance * change.transpose();
}

/// Each of the pose's six numbers is within its own interval, and so is the robot's middle, whose
/// standard deviation says a millimetre along its worst direction (noise, and what the two meshes
/// differ by). Which frames are taken differs from run to run: the intervals are those of 99.9 %.
inline void ExpectRight(const Found& found, const Eigen::Isometry3d& truth) {
  constexpr double kSigmas = 3.29, kChiSquared3 = 16.27;
  const Eigen::AngleAxisd turn(truth.linear() * found.T_robot_camera.linear().transpose());
  Eigen::Matrix<double, 6, 1> off;
  off << truth.translation() - found.T_robot_camera.translation(), turn.angle() * turn.axis();
  const Eigen::Matrix<double, 6, 1> sigma = found.covariance.diagonal().cwiseSqrt();
  for (int k = 0; k < 6; ++k) EXPECT_LE(std::abs(off[k]), kSigmas * sigma[k]) << "number " << k;
  EXPECT_LT(sigma.head<3>().maxCoeff(), 0.01);
  EXPECT_LT(sigma.tail<3>().maxCoeff(), 0.03);
  const Eigen::Vector3d middle_m = truth.inverse() * Eigen::Vector3d(0.0, 0.0, 0.065);
  const Eigen::Vector3d off_m = found.T_robot_camera * middle_m - truth * middle_m;
  const Eigen::Matrix3d covariance_m2 =
      CovarianceOfPoint(found, found.T_robot_camera.linear() * middle_m);
  EXPECT_LT(off_m.dot(Eigen::LDLT<Eigen::Matrix3d>(covariance_m2).solve(off_m)), kChiSquared3)
      << off_m.transpose();
  EXPECT_LT(std::sqrt(covariance_m2.diagonal().maxCoeff()), 1.5e-3);
}

}  // namespace palpate::system_test
