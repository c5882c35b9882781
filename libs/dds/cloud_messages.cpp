// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/cloud_messages.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::dds {

namespace {

static_assert(std::endian::native == std::endian::little, "points travel in the host's order");

/// One point on the wire.
struct Point {
  std::array<float, 3> position_m;
  std::uint32_t rgb;
  float sigma_m;
};
static_assert(sizeof(Point) == 20);

constexpr std::array<std::string_view, 5> kFields = {"x", "y", "z", "rgb", "sigma"};

Status CheckLayout(const idl::sensor_msgs::PointCloud2& message) {
  bool fits = message.fields._length == kFields.size() && message.point_step == sizeof(Point) &&
              !message.is_bigendian;
  for (std::uint32_t i = 0; fits && i < kFields.size(); ++i) {
    const auto& field = message.fields._buffer[i];
    fits = Text(field.name) == kFields[i] && field.offset == 4 * i && field.count == 1 &&
           field.datatype == sensor_msgs_msg_PointField_Constants_FLOAT32;
  }
  if (!fits) return Invalid("a cloud of another layout than x, y, z, rgb, sigma (FLOAT32)");
  const std::uint64_t points = std::uint64_t{message.width} * message.height;
  if (message.height != 1 || message.data._length != points * sizeof(Point)) {
    return Invalid("a cloud of " + std::to_string(message.width) + " x " +
                   std::to_string(message.height) + " points and " +
                   std::to_string(message.data._length) + " bytes");
  }
  return Status::Ok();
}

bool IsUsable(const Point& point) {
  for (const float coordinate_m : point.position_m) {
    if (!std::isfinite(coordinate_m)) return false;
  }
  return std::isfinite(point.sigma_m) && point.sigma_m > 0.0f;
}

void SetFields(idl::sensor_msgs::PointCloud2& message) {
  Resize(message.fields, kFields.size());
  for (std::uint32_t i = 0; i < kFields.size(); ++i) {
    auto& field = message.fields._buffer[i];
    SetText(field.name, kFields[i]);
    field.offset = 4 * i;
    field.datatype = sensor_msgs_msg_PointField_Constants_FLOAT32;
    field.count = 1;
  }
}

}  // namespace

Message<idl::sensor_msgs::PointCloud2> ToPointCloud2(const rgbd::SensedCloud& cloud,
                                                     std::int64_t stamp_ns,
                                                     std::string_view frame_id) {
  const Eigen::Index count = cloud.Count();
  PALPATE_CHECK(cloud.sigma_m.size() == count, cloud.sigma_m.size(), count);
  PALPATE_CHECK(cloud.colors_rgb.size() == static_cast<std::size_t>(3 * count), count);
  Message<idl::sensor_msgs::PointCloud2> message;
  SetHeader(message->header, stamp_ns, frame_id);
  SetFields(*message);
  message->height = 1;
  message->width = static_cast<std::uint32_t>(count);
  message->point_step = sizeof(Point);
  message->row_step = message->width * message->point_step;
  message->is_dense = true;
  Resize(message->data, message->row_step);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::uint8_t* color = cloud.colors_rgb.data() + 3 * i;
    Point point;
    std::memcpy(point.position_m.data(), cloud.points_m.col(i).data(), sizeof(point.position_m));
    point.rgb = std::uint32_t{color[0]} << 16 | std::uint32_t{color[1]} << 8 | color[2];
    point.sigma_m = cloud.sigma_m[i];
    std::memcpy(message->data._buffer + sizeof(Point) * static_cast<std::size_t>(i), &point,
                sizeof(Point));
  }
  return message;
}

Status FromPointCloud2(const idl::sensor_msgs::PointCloud2& message, rgbd::SensedCloud* cloud) {
  if (Status layout = CheckLayout(message); !layout.ok()) return layout;
  const auto count = ToIndex(message.width);
  cloud->points_m.resize(3, count);
  cloud->sigma_m.resize(count);
  cloud->colors_rgb.resize(static_cast<std::size_t>(3 * count));
  for (Eigen::Index i = 0; i < count; ++i) {
    Point point;
    std::memcpy(&point, message.data._buffer + sizeof(Point) * static_cast<std::size_t>(i),
                sizeof(Point));
    if (!IsUsable(point)) return Invalid("point " + std::to_string(i) + " of a cloud is no number");
    std::memcpy(cloud->points_m.col(i).data(), point.position_m.data(), sizeof(point.position_m));
    cloud->sigma_m[i] = point.sigma_m;
    std::uint8_t* color = cloud->colors_rgb.data() + 3 * i;
    color[0] = static_cast<std::uint8_t>(point.rgb >> 16);
    color[1] = static_cast<std::uint8_t>(point.rgb >> 8);
    color[2] = static_cast<std::uint8_t>(point.rgb);
  }
  return Status::Ok();
}

}  // namespace palpate::dds
