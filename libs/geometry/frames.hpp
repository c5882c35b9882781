// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>

namespace palpate::geometry {

/// Names of the coordinate frames, as `frame_id` of messages and `frame` of files spell them.
/// All are right-handed, in metres.
inline constexpr std::string_view kRobotFrame = "robot";  ///< fixed to the robot's base
/// x right, y down, z along the optical axis of the depth camera.
inline constexpr std::string_view kCameraDepthOpticalFrame = "camera_depth_optical_frame";
/// The same of the colour camera.
inline constexpr std::string_view kCameraColorOpticalFrame = "camera_color_optical_frame";
inline constexpr std::string_view kWorldFrame = "world";

}  // namespace palpate::geometry
