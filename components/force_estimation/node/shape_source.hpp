// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/force_estimation/node/frame_source.hpp"
#include "libs/core/repetition_check.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/driver_topics.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/dds/wait_set.hpp"
#include "libs/geometry/depth_picture.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Frames of /perception/robot_cloud, /perception/report and /perception/contacts of one stamp, and
/// of the report of each camera beside the first.
class ShapeSource : public FrameSource {
 public:
  /// `T_robot_camera`: nullopt: unknown, and frames are refused until SetCalibration gives it, or
  /// /tf and /tf_static join the robot with the camera. `cameras`: those beside the first, each
  /// with its pose.
  ShapeSource(dds::Participant& participant, dds::WaitSet& loop,
              const std::optional<Eigen::Isometry3d>& T_robot_camera, TakeArrival take,
              const std::vector<dds::FurtherCamera>& cameras = {});

  /// Takes the camera poses and depth biases that it holds. Frames of other images than its depth
  /// bias is for are refused.
  void SetCalibration(const robot::CalibrationFile& calibration) override;

  void ExpectInputs(dds::InputMonitor& inputs) const override;

  std::string name() const override { return "clouds"; }
  uint64_t dropped() const override { return dropped_; }
  bool knows_camera_pose() const override { return T_robot_camera_.has_value(); }
  uint32_t writers() const override { return contacts_.matched(); }
  uint32_t incompatible_qos() const override;

 private:
  /// Camera and time of a frame.
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
    double age_s = 0.0;  ///< of the frame, when it was sent
    rgbd::TexturePoints texture;
    /// By which perception put the points of a further camera into the frame of the first.
    Eigen::Isometry3d T_first_camera = Eigen::Isometry3d::Identity();
  };
  /// The parts of a frame that have come so far.
  struct Parts {
    int64_t stamp_ns = 0;
    Status status = Status::Ok();           ///< of the last part that is invalid
    std::optional<dds::JoinedCloud> cloud;  ///< of all cameras, in the frame of the first
    std::vector<rgbd::SensedCloud> clouds;  ///< of each camera, in its frame, once complete
    std::optional<Report> report;
    std::vector<std::optional<Report>> further;  ///< of the cameras beside the first
    std::optional<std::vector<SeenContact>> contacts;

    bool is_complete() const;
  };
  /// A camera beside the first.
  struct Further {
    std::string name;
    Eigen::Isometry3d T_robot_camera;
    dds::Reader<idl::palpate_msgs::PerceptionReport> reports;
    std::optional<robot::CalibratedDepthBias> depth_bias = {};
  };

  void TakeClouds();
  Status FromCloud(const idl::sensor_msgs::PointCloud2& message, dds::JoinedCloud* cloud) const;
  Status CheckIsNew(const idl::sensor_msgs::PointCloud2& message, const rgbd::SensedCloud& points);
  void TakeReports(dds::Reader<idl::palpate_msgs::PerceptionReport>& reader,
                   std::optional<std::size_t> further);
  void TakeContacts();
  void TakeTransforms(dds::Reader<idl::tf2_msgs::TFMessage>& reader);
  Parts* PartsAt(int64_t stamp_ns);
  void HandOverComplete();
  void SplitCloud(Parts* parts) const;
  FrameArrival ArrivalOf(Parts parts);
  std::optional<SequenceStart> SequenceOf(const Origin& origin);
  Status Check(const Parts& parts) const;
  FrameInput InputOf(Parts parts) const;

  /// More than all readers hold at once: frames that lost a part never push out complete ones.
  static constexpr size_t kMostPending = 32;

  /// The transforms by which the camera is found where neither settings nor calibration have it.
  struct Transforms {
    dds::Reader<idl::tf2_msgs::TFMessage> at_rest;
    dds::Reader<idl::tf2_msgs::TFMessage> moving;
    dds::TransformTree tree = {};
  };

  std::optional<Eigen::Isometry3d> T_robot_camera_;
  bool is_calibrated_ = false;            ///< the pose is that of a calibration
  std::optional<Transforms> transforms_;  ///< nullopt: the pose is known otherwise
  std::optional<robot::CalibratedDepthBias> depth_bias_;
  dds::Reader<idl::sensor_msgs::PointCloud2> clouds_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Reader<idl::palpate_msgs::ContactArray> contacts_;
  std::vector<std::unique_ptr<Further>> further_;
  std::deque<Parts> pending_;  ///< in the order in which their first part came
  std::shared_ptr<dds::RosClock> clock_;
  RepetitionCheck repetition_;  ///< of clouds
  std::optional<Origin> last_;
  FrameHead last_head_;
  uint64_t dropped_ = 0;
};

}  // namespace palpate::force_estimation
