// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "libs/dds/camera_messages.hpp"
#include "libs/dds/camera_topics.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::dds {

/// Writes the topics of an RGB-D camera. To be used by one thread: writing 2 MB takes up to 25 ms.
/// All functions return false where DDS did not take all of it.
class CameraPublisher {
 public:
  /// `camera`: name of a camera beside the first; empty: the first. Throws InputError for a name
  /// that is none.
  explicit CameraPublisher(Participant& participant, const std::function<void()>& on_change = {},
                           const std::string& camera = {});

  /// Set-up and lenses; on /tf_static the place of a colour camera beside the depth camera and,
  /// where it is known, that of the depth camera. Before the frames of an epoch.
  [[nodiscard]] bool PublishCamera(const rgbd::RgbdCamera& camera, const CameraIdentity& identity,
                                   std::int64_t stamp_ns,
                                   const std::optional<Eigen::Isometry3d>& T_robot_camera = {});
  /// Depth, colour (where there is any) and what is known about them, under one stamp.
  [[nodiscard]] bool PublishFrame(const rgbd::RgbdCamera& camera, const rgbd::RgbdFrame& images,
                                  std::int64_t stamp_ns, const idl::palpate_msgs::FrameInfo& info);

  /// Waits until all reliable readers have what was sent.
  [[nodiscard]] bool WaitUntilReceived(std::chrono::nanoseconds at_most);
  /// The name of the depth image's topic.
  const std::string& depth_topic() const { return depth_.ros_name(); }
  /// The frame of the depth image.
  const std::string& depth_frame() const { return of_.depth_frame; }
  /// Of the frame info.
  std::uint32_t readers() const { return info_.matched(); }
  /// Whether images and frame info all have a reader.
  bool is_read() const {
    return depth_.matched() > 0 && color_.matched() > 0 && info_.matched() > 0;
  }

 private:
  /// Registered colour is in the depth camera's frame.
  const std::string& ColorFrame(const rgbd::RgbdCamera& camera) const {
    return camera.color_registered ? of_.depth_frame : of_.color_frame;
  }

  CameraTopics of_;
  Writer<idl::sensor_msgs::Image> depth_;
  Writer<idl::sensor_msgs::Image> color_;
  Writer<idl::sensor_msgs::CameraInfo> depth_camera_;
  Writer<idl::sensor_msgs::CameraInfo> color_camera_;
  Writer<idl::palpate_msgs::FrameInfo> info_;
  Writer<idl::palpate_msgs::CameraSetup> setup_;
  TransformBroadcaster transforms_;
  ImageMessage depth_message_{"16UC1", 2};
  ImageMessage color_message_{"rgb8", 3};
};

}  // namespace palpate::dds
