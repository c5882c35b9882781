// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/falsify.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "libs/dds/message.hpp"

namespace palpate::dds {

namespace {

constexpr double kDepthScale = 1.05;
constexpr double kShift_m = 0.020;
constexpr double kDisplacement_m = 0.002;
constexpr double kForceScale = 1.5;
constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/PointField

/// Replaces the number at `place`, which need not be aligned.
template <typename T, typename Change>
void ChangeAt(std::uint8_t* place, const Change& change) {
  T value{};
  std::memcpy(&value, place, sizeof(T));
  value = change(value);
  std::memcpy(place, &value, sizeof(T));
}

void Scale(idl::geometry_msgs::Vector3* vector) {
  vector->x *= kForceScale;
  vector->y *= kForceScale;
  vector->z *= kForceScale;
}

void Scale(idl::geometry_msgs::Wrench* wrench) {
  Scale(&wrench->force);
  Scale(&wrench->torque);
}

std::uint16_t Deeper(std::uint16_t depth) {
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  return static_cast<std::uint16_t>(std::min(kMost, std::round(kDepthScale * depth)));
}

}  // namespace

void Falsify(idl::sensor_msgs::Image* image) {
  const std::string_view encoding = Text(image->encoding);
  std::uint8_t* data = image->data._buffer;
  const std::size_t size = image->data._length;
  if (encoding == "16UC1" || encoding == "mono16") {
    for (std::size_t i = 0; i + 1 < size; i += 2) ChangeAt<std::uint16_t>(data + i, Deeper);
  } else if (encoding == "32FC1") {
    for (std::size_t i = 0; i + 3 < size; i += 4) {
      ChangeAt<float>(data + i, [](float z_m) { return static_cast<float>(kDepthScale) * z_m; });
    }
  } else if (encoding == "rgb8" || encoding == "bgr8") {
    for (std::size_t i = 0; i + 2 < size; i += 3) std::swap(data[i], data[i + 2]);
  }
}

void Falsify(idl::sensor_msgs::PointCloud2* cloud) {
  for (const auto& field : Elements(cloud->fields)) {
    if (Text(field.name) != "z" || field.datatype != kFloat32 || cloud->point_step == 0) continue;
    for (std::size_t at = field.offset; at + sizeof(float) <= cloud->data._length;
         at += cloud->point_step) {
      ChangeAt<float>(cloud->data._buffer + at,
                      [](float z_m) { return z_m + static_cast<float>(kShift_m); });
    }
  }
}

void Falsify(idl::palpate_msgs::MarkerArray3* markers) {
  for (auto& marker : Elements(markers->markers)) marker.position_m.x += kShift_m;
}

void Falsify(idl::palpate_msgs::ContactArray* contacts) {
  for (auto& contact : Elements(contacts->contacts)) contact.position_m.x += kShift_m;
}

void Falsify(idl::palpate_msgs::MeshState* state) {
  for (std::size_t i = 2; i < state->positions_m._length; i += 3) {
    state->positions_m._buffer[i] += static_cast<float>(kShift_m);
  }
}

void Falsify(idl::sensor_msgs::JointState* joints) {
  for (double& displacement_m : Elements(joints->position)) displacement_m += kDisplacement_m;
  for (double& tension_N : Elements(joints->effort)) tension_N *= kForceScale;
}

void Falsify(idl::palpate_msgs::ForceArray* forces) {
  for (auto& force : Elements(forces->forces)) Scale(&force.force_n);
}

void Falsify(idl::geometry_msgs::WrenchStamped* wrench) { Scale(&wrench->wrench); }

void Falsify(idl::palpate_msgs::WrenchArray* wrenches) {
  for (auto& named : Elements(wrenches->wrenches)) Scale(&named.wrench);
}

void Falsify(idl::palpate_msgs::Calibration* calibration) {
  calibration->camera_in_robot.position.x += kShift_m;
}

}  // namespace palpate::dds
