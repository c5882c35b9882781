// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string_view>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "sensor_msgs/msg/PointCloud2.hpp"

namespace palpate::dds {

/// 20 bytes a point: x, y, z, rgb (0x00RRGGBB in the bits of a float, as ROS has it), sigma; one
/// row, dense.
Message<idl::sensor_msgs::PointCloud2> ToPointCloud2(const rgbd::SensedCloud& cloud,
                                                     std::int64_t stamp_ns,
                                                     std::string_view frame_id);

/// The same numbers again, bit by bit; of a cloud of several cameras, the points of the first.
/// kInvalidInput for another layout, data that do not go with the size, a point that is not finite,
/// a sigma that is not above 0.
Status FromPointCloud2(const idl::sensor_msgs::PointCloud2& message, rgbd::SensedCloud* cloud);

/// Points of several cameras in one frame. `sigma_m` is along the optical axis of the camera that
/// saw the point.
struct JoinedCloud {
  rgbd::SensedCloud points;
  std::vector<std::uint32_t> cameras;  ///< [n] number of the camera that saw it; 0: the first
};

/// 24 bytes a point: as above, then camera (UINT32).
Message<idl::sensor_msgs::PointCloud2> ToJoinedPointCloud2(const JoinedCloud& cloud,
                                                           std::int64_t stamp_ns,
                                                           std::string_view frame_id);

/// The same again; a cloud without `camera` is of the first. kInvalidInput as above.
Status FromJoinedPointCloud2(const idl::sensor_msgs::PointCloud2& message, JoinedCloud* cloud);

/// Points by the camera that saw them, those of further cameras mapped into its frame.
/// `T_camera_first`: of the cameras beside the first; `clouds` [1 + T_camera_first.size()].
/// kInvalidInput for a point of a camera beyond these.
Status SplitCloud(const JoinedCloud& joined, const std::vector<Eigen::Isometry3d>& T_camera_first,
                  std::vector<rgbd::SensedCloud>* clouds);

}  // namespace palpate::dds
