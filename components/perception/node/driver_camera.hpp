// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "libs/core/status.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "sensor_msgs/msg/CameraInfo.hpp"

namespace palpate::perception {

/// One image stream of a driver with its camera_info.
struct DriverStream {
  std::string image_topic;
  std::string info_topic;
  std::string frame;  ///< of the last image; empty: none has come
  std::optional<rgbd::CameraModel> lens;
  Status lens_status = Status::Ok();  ///< of the last camera_info

  /// "/a/image_rect", "/a/image_rect_raw", "/a/image_rect/compressed": ROS names rectified images
  /// so.
  bool is_rectified() const;
  void SetInfo(const idl::sensor_msgs::CameraInfo& message);
  /// kNoCalibration where no camera_info has come or it has no intrinsics, kInvalidInput for one
  /// that cannot be used; each with the topic and the remedy.
  Status CheckLens() const;
};

/// What a driver's messages say about its camera, put together.
class DriverCamera {
 public:
  /// `T_depth_color`: of the settings; nullopt: from the messages.
  DriverCamera(std::optional<Eigen::Isometry3d> T_depth_color, double baseline_m)
      : given_(std::move(T_depth_color)), baseline_m_(baseline_m) {}

  DriverStream& depth() { return depth_; }
  const DriverStream& depth() const { return depth_; }
  DriverStream& color() { return color_; }
  const DriverStream& color() const { return color_; }
  Status AddTransforms(const idl::tf2_msgs::TFMessage& message) { return frames_.Add(message); }
  /// Where the transforms have the depth camera now; nullopt: they do not join it with the robot.
  std::optional<Eigen::Isometry3d> T_robot_depth() const {
    return frames_.Find(std::string(geometry::kRobotFrame), depth_.frame);
  }

  /// The camera of a frame with or without colour, for depth in steps of `depth_unit_m`. Colour is
  /// registered where both images have one frame, size and lens. Otherwise kNoCalibration where
  /// nothing says how the cameras stand to each other.
  Status CameraOf(bool with_color, double depth_unit_m, rgbd::RgbdCamera* camera) const;

 private:
  Status AddColor(rgbd::RgbdCamera* camera) const;

  std::optional<Eigen::Isometry3d> given_;
  double baseline_m_;
  DriverStream depth_;
  DriverStream color_;
  dds::TransformTree frames_;
};

}  // namespace palpate::perception
