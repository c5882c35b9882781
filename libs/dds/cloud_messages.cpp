// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/cloud_messages.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
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

constexpr std::array<std::string_view, 6> kFields = {"x", "y", "z", "rgb", "sigma", "camera"};
constexpr std::size_t kFieldsOfOneCamera = 5;
/// Of a point of several cameras.
constexpr std::size_t kJoinedStep = sizeof(Point) + sizeof(std::uint32_t);

std::uint8_t TypeOf(std::size_t field) {
  return field < kFieldsOfOneCamera ? sensor_msgs_msg_PointField_Constants_FLOAT32
                                    : sensor_msgs_msg_PointField_Constants_UINT32;
}

Status CheckLayout(const idl::sensor_msgs::PointCloud2& message) {
  const std::size_t fields = message.fields._length;
  bool fits = (fields == kFieldsOfOneCamera || fields == kFields.size()) &&
              message.point_step == 4 * fields && !message.is_bigendian;
  for (std::uint32_t i = 0; fits && i < fields; ++i) {
    const auto& field = message.fields._buffer[i];
    fits = Text(field.name) == kFields[i] && field.offset == 4 * i && field.count == 1 &&
           field.datatype == TypeOf(i);
  }
  if (!fits) {
    return Invalid("a cloud of another layout than x, y, z, rgb, sigma (FLOAT32), camera (UINT32)");
  }
  const std::uint64_t points = std::uint64_t{message.width} * message.height;
  if (message.height != 1 || message.data._length != points * message.point_step) {
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

void SetFields(std::size_t count, idl::sensor_msgs::PointCloud2& message) {
  Resize(message.fields, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    auto& field = message.fields._buffer[i];
    SetText(field.name, kFields[i]);
    field.offset = 4 * i;
    field.datatype = TypeOf(i);
    field.count = 1;
  }
}

/// With room for `fields` of each point, of which all but the camera are set.
Message<idl::sensor_msgs::PointCloud2> MessageOf(const rgbd::SensedCloud& cloud, std::size_t fields,
                                                 std::int64_t stamp_ns, std::string_view frame_id) {
  const Eigen::Index count = cloud.Count();
  PALPATE_CHECK(cloud.sigma_m.size() == count, cloud.sigma_m.size(), count);
  PALPATE_CHECK(cloud.colors_rgb.size() == static_cast<std::size_t>(3 * count), count);
  Message<idl::sensor_msgs::PointCloud2> message;
  SetHeader(message->header, stamp_ns, frame_id);
  SetFields(fields, *message);
  message->height = 1;
  message->width = static_cast<std::uint32_t>(count);
  message->point_step = static_cast<std::uint32_t>(4 * fields);
  message->row_step = message->width * message->point_step;
  message->is_dense = true;
  Resize(message->data, message->row_step);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::uint8_t* color = cloud.colors_rgb.data() + 3 * i;
    Point point;
    std::memcpy(point.position_m.data(), cloud.points_m.col(i).data(), sizeof(point.position_m));
    point.rgb = std::uint32_t{color[0]} << 16 | std::uint32_t{color[1]} << 8 | color[2];
    point.sigma_m = cloud.sigma_m[i];
    std::memcpy(message->data._buffer + message->point_step * static_cast<std::size_t>(i), &point,
                sizeof(Point));
  }
  return message;
}

/// Numbers of the cameras of all points.
std::vector<std::uint32_t> CamerasOf(const idl::sensor_msgs::PointCloud2& message) {
  std::vector<std::uint32_t> cameras(message.width, 0);
  if (message.point_step != kJoinedStep) return cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::memcpy(&cameras[i], message.data._buffer + kJoinedStep * i + sizeof(Point),
                sizeof(std::uint32_t));
  }
  return cameras;
}

/// Takes the points `chosen` of a message of known layout.
Status TakePoints(const idl::sensor_msgs::PointCloud2& message,
                  const std::vector<std::size_t>& chosen, rgbd::SensedCloud* cloud) {
  const Eigen::Index count = ToIndex(chosen.size());
  cloud->points_m.resize(3, count);
  cloud->sigma_m.resize(count);
  cloud->colors_rgb.resize(3 * chosen.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t number = chosen[At(i)];
    Point point;
    std::memcpy(&point, message.data._buffer + message.point_step * number, sizeof(Point));
    if (!IsUsable(point)) {
      return Invalid("point " + std::to_string(number) + " of a cloud is no number");
    }
    std::memcpy(cloud->points_m.col(i).data(), point.position_m.data(), sizeof(point.position_m));
    cloud->sigma_m[i] = point.sigma_m;
    std::uint8_t* color = cloud->colors_rgb.data() + 3 * i;
    color[0] = static_cast<std::uint8_t>(point.rgb >> 16);
    color[1] = static_cast<std::uint8_t>(point.rgb >> 8);
    color[2] = static_cast<std::uint8_t>(point.rgb);
  }
  return Status::Ok();
}

}  // namespace

Message<idl::sensor_msgs::PointCloud2> ToPointCloud2(const rgbd::SensedCloud& cloud,
                                                     std::int64_t stamp_ns,
                                                     std::string_view frame_id) {
  return MessageOf(cloud, kFieldsOfOneCamera, stamp_ns, frame_id);
}

Message<idl::sensor_msgs::PointCloud2> ToJoinedPointCloud2(const JoinedCloud& cloud,
                                                           std::int64_t stamp_ns,
                                                           std::string_view frame_id) {
  PALPATE_CHECK(ToIndex(cloud.cameras.size()) == cloud.points.Count(), cloud.cameras.size());
  auto message = MessageOf(cloud.points, kFields.size(), stamp_ns, frame_id);
  for (std::size_t i = 0; i < cloud.cameras.size(); ++i) {
    std::memcpy(message->data._buffer + kJoinedStep * i + sizeof(Point), &cloud.cameras[i],
                sizeof(std::uint32_t));
  }
  return message;
}

Status FromPointCloud2(const idl::sensor_msgs::PointCloud2& message, rgbd::SensedCloud* cloud) {
  if (Status layout = CheckLayout(message); !layout.ok()) return layout;
  const std::vector<std::uint32_t> cameras = CamerasOf(message);
  std::vector<std::size_t> of_first;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i] == 0) of_first.push_back(i);
  }
  return TakePoints(message, of_first, cloud);
}

Status FromJoinedPointCloud2(const idl::sensor_msgs::PointCloud2& message, JoinedCloud* cloud) {
  if (Status layout = CheckLayout(message); !layout.ok()) return layout;
  cloud->cameras = CamerasOf(message);
  std::vector<std::size_t> all(message.width);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return TakePoints(message, all, &cloud->points);
}

Status SplitCloud(const JoinedCloud& joined, const std::vector<Eigen::Isometry3d>& T_camera_first,
                  std::vector<rgbd::SensedCloud>* clouds) {
  std::vector<std::vector<Eigen::Index>> columns(1 + T_camera_first.size());
  clouds->assign(columns.size(), {});
  for (std::size_t i = 0; i < joined.cameras.size(); ++i) {
    const std::size_t camera = joined.cameras[i];
    if (camera >= columns.size()) {
      return Invalid("a point of camera " + std::to_string(camera) + ": the settings have " +
                     std::to_string(columns.size()) + " cameras");
    }
    columns[camera].push_back(ToIndex(i));
  }
  for (std::size_t k = 0; k < columns.size(); ++k) {
    rgbd::SensedCloud& cloud = (*clouds)[k];
    cloud.points_m = joined.points.points_m(Eigen::all, columns[k]);
    cloud.sigma_m = joined.points.sigma_m(columns[k]);
    for (const Eigen::Index i : columns[k]) {
      const auto rgb = joined.points.colors_rgb.begin() + 3 * i;
      cloud.colors_rgb.insert(cloud.colors_rgb.end(), rgb, rgb + 3);
    }
    if (k == 0) continue;
    cloud.points_m = (T_camera_first[k - 1] * cloud.points_m.cast<double>()).cast<float>().eval();
  }
  return Status::Ok();
}

}  // namespace palpate::dds
