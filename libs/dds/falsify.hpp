// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <concepts>

#include "geometry_msgs/msg/Vector3.hpp"
#include "geometry_msgs/msg/Wrench.hpp"
#include "geometry_msgs/msg/WrenchStamped.hpp"
#include "palpate_msgs/msg/Calibration.hpp"
#include "palpate_msgs/msg/ContactArray.hpp"
#include "palpate_msgs/msg/ForceArray.hpp"
#include "palpate_msgs/msg/MarkerArray3.hpp"
#include "palpate_msgs/msg/MeshState.hpp"
#include "palpate_msgs/msg/WrenchArray.hpp"
#include "sensor_msgs/msg/Image.hpp"
#include "sensor_msgs/msg/JointState.hpp"
#include "sensor_msgs/msg/PointCloud2.hpp"

namespace palpate::dds {

/// Make the data of a message wrong in a way that its form does not show (FaultKind::kWrong). All
/// else stays. There is one for each type of which that can be said.

/// Depth 5 % too large, as of a camera with a wrong baseline; red and blue of colours swapped.
void Falsify(idl::sensor_msgs::Image* image);
/// All points 20 mm farther from the camera.
void Falsify(idl::sensor_msgs::PointCloud2* cloud);
/// All 20 mm along x of the frame.
void Falsify(idl::palpate_msgs::MarkerArray3* markers);
void Falsify(idl::palpate_msgs::ContactArray* contacts);
/// All 20 mm along z of the robot.
void Falsify(idl::palpate_msgs::MeshState* state);
/// Displacements 2 mm too large, tensions half as large again.
void Falsify(idl::sensor_msgs::JointState* joints);
/// Half as large again.
void Falsify(idl::palpate_msgs::ForceArray* forces);
void Falsify(idl::geometry_msgs::WrenchStamped* wrench);
void Falsify(idl::palpate_msgs::WrenchArray* wrenches);
/// The camera 20 mm off, along x of the robot.
void Falsify(idl::palpate_msgs::Calibration* calibration);

template <typename T>
concept CanBeFalsified = requires(T* message) {
  Falsify(message);
};

/// Gives `held` stamp, counters and frame of `now`, so that it passes for a new message.
template <typename T>
void CopyHead(const T& now, T* held) {
  if constexpr (requires { now.header.stamp; }) held->header.stamp = now.header.stamp;
  if constexpr (requires { now.counter; }) held->counter = now.counter;
  if constexpr (requires { now.frame_counter; }) held->frame_counter = now.frame_counter;
  if constexpr (requires { now.marker_counter; }) held->marker_counter = now.marker_counter;
  if constexpr (requires { now.epoch; }) held->epoch = now.epoch;
  if constexpr (requires { now.stamp_host_ns; }) {
    held->frame_id = now.frame_id;
    held->stamp_host_ns = now.stamp_host_ns;
    held->stamp_device_ns = now.stamp_device_ns;
    held->stamp_receive_ns = now.stamp_receive_ns;
  }
}

}  // namespace palpate::dds
