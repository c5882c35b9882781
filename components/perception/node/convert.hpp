// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/perception/joint_perception.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/camera_topics.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/message.hpp"
#include "libs/geometry/depth_picture.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// Pixels of a camera's depth/image_raw (16UC1). kInvalidInput for another frame or encoding, rows
/// or data that are too short.
Status FromDepthImage(const idl::sensor_msgs::Image& message, const dds::CameraTopics& camera,
                      rgbd::DepthImage* image);
/// The same of color/image_raw (rgb8), which may be in the frame of the depth or the colour camera.
Status FromColorImage(const idl::sensor_msgs::Image& message, const dds::CameraTopics& camera,
                      rgbd::ColorImage* image);

/// What holds for an epoch of a camera.
struct CameraSetup {
  std::int64_t stamp_ns = 0;
  std::uint32_t epoch = 0;
  std::string device;
  rgbd::RgbdCamera camera;  ///< without the lenses
  std::optional<double> subpixel_sigma_px;
};
/// kInvalidInput for units that are no lengths, an invalid value beyond 16 bits, a pose that is
/// none.
Status FromCameraSetup(const idl::palpate_msgs::CameraSetup& message, CameraSetup* setup);

/// Where one camera's part of a frame came from.
struct CameraOrigin {
  std::string name;  ///< empty: the first camera
  std::uint64_t frame_counter = 0;
  std::uint32_t epoch = 0;
  std::string device;
  geometry::DepthPicture picture;  ///< of the depth image
  /// Why it has no part in the frame; ok: it has.
  Status status = Status::Ok();
  Eigen::Isometry3d T_first_camera = Eigen::Isometry3d::Identity();
};

/// What comes of one frame, and where it came from.
struct FrameOutcome {
  std::int64_t stamp_ns = 0;
  std::vector<CameraOrigin> cameras;     ///< of which there is one at least
  std::int64_t prediction_stamp_ns = 0;  ///< 0: none was used
  JointObservation observation;          ///< of the same cameras
  std::vector<std::string> notes;        ///< of the process, beside those of the observation

  /// Of `camera` of the cameras, in words: "the first camera", "camera 'back'".
  std::string NameOf(std::size_t camera) const;
};

/// Of the whole frame, in the frame of the first camera; texture, pixels and origin are the first
/// camera's. Counter, age and latency are set by the sender.
dds::Message<idl::palpate_msgs::PerceptionReport> ToReport(const FrameOutcome& outcome);
/// Of one camera alone, in its own frame, as /perception/camera_NAME/report has it.
dds::Message<idl::palpate_msgs::PerceptionReport> ToReportOf(const FrameOutcome& outcome,
                                                             std::size_t camera,
                                                             const std::string& depth_frame);
/// Counter as above.
dds::Message<idl::palpate_msgs::ContactArray> ToContactArray(const FrameOutcome& outcome);

/// The robot's points that all cameras see, in the frame of the first one.
dds::JoinedCloud JoinedRobotCloud(const FrameOutcome& outcome);
/// The same of objects near the robot.
dds::JoinedCloud JoinedObjectCloud(const FrameOutcome& outcome);

}  // namespace palpate::perception
