// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>
#include <string>

#include "components/force_estimation/node/frame_source.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"
#include "libs/geometry/depth_picture.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Frames from /perception/robot_cloud, /perception/report and /perception/contacts of one stamp.
class ShapeSource : public FrameSource {
 public:
  /// `T_robot_camera`: nullopt: not known yet, frames are refused until it is set.
  ShapeSource(dds::Participant& participant, dds::WaitSet& loop,
              const std::optional<Eigen::Isometry3d>& T_robot_camera, FrameEvents events);

  /// Frames of other images than its depth bias is for are refused.
  void SetCalibration(const robot::CalibrationFile& calibration) override;

  std::string name() const override { return "clouds"; }
  uint64_t dropped() const override { return dropped_; }
  uint32_t writers() const override { return contacts_.matched(); }
  uint32_t incompatible_qos() const override {
    return clouds_.counters().incompatible_qos + reports_.counters().incompatible_qos +
           contacts_.counters().incompatible_qos;
  }

 private:
  /// Where a frame came from.
  struct Origin {
    int64_t stamp_ns = 0;
    uint32_t epoch = 0;
    std::string device;
    geometry::DepthPicture picture;
  };
  struct Report {
    Origin origin;
    uint64_t frame_counter = 0;
    Status perception;
  };
  /// The parts of a frame, as far as they have come.
  struct Parts {
    int64_t stamp_ns = 0;
    Status status = Status::Ok();  ///< the first thing that is wrong with one
    std::optional<rgbd::SensedCloud> cloud;
    std::optional<Report> report;
    std::optional<std::vector<SeenContact>> contacts;
  };

  void TakeClouds();
  void TakeReports();
  void TakeContacts();
  Parts* PartsAt(int64_t stamp_ns);
  void PassOn();
  void Accept(Parts parts);
  void Judge(const Origin& origin);

  /// More than all readers hold at once: what came whole is never pushed out by what lost a part.
  static constexpr size_t kMostPending = 32;

  std::optional<Eigen::Isometry3d> T_robot_camera_;
  std::optional<robot::CalibratedDepthBias> depth_bias_;
  dds::Reader<idl::sensor_msgs::PointCloud2> clouds_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Reader<idl::palpate_msgs::ContactArray> contacts_;
  std::deque<Parts> pending_;  ///< in the order of their first part's coming
  std::optional<Origin> last_;
  FrameHead last_head_;
  uint64_t dropped_ = 0;
};

}  // namespace palpate::force_estimation
