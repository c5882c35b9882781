// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/virtual_camera/embree_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace palpate::virtual_camera {

namespace {

constexpr double kTolerance_m = 1e-5;
constexpr double kSilhouette_px = 1e-3;
constexpr double kRim_m = 1e-4;
constexpr unsigned kPrismSides = 512;

void SetVertices(RTCGeometry geometry, const Eigen::Matrix3Xd& points_m) {
  auto* floats = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), static_cast<std::size_t>(points_m.cols())));
  for (Eigen::Index i = 0; i < points_m.size(); ++i) {
    floats[i] = static_cast<float>(points_m.data()[i]);
  }
}

// Same depth to the tolerance; two misses agree.
bool Agrees(double a, double b) {
  return (std::isinf(a) && std::isinf(b)) || std::abs(a - b) <= kTolerance_m;
}

// Whether an edge passes within kSilhouette_px of the ray, and `z` is right for one of its sides,
// or for the very rim of a round shape, where depth changes as the root of the distance to it.
template <typename CastOff>
bool IsRightNearby(double z, double wanted, const CastOff& cast) {
  bool at_edge = false;
  for (int k = 0; k < 8; ++k) {
    const double angle = k * M_PI / 4.0;
    const double there = cast(kSilhouette_px * std::cos(angle), kSilhouette_px * std::sin(angle));
    if (Agrees(z, there)) return true;
    at_edge = at_edge || !(std::abs(there - wanted) < kRim_m);
  }
  return at_edge && std::abs(z - wanted) < kRim_m;
}

}  // namespace

EmbreeOracle::EmbreeOracle(const Drawing& drawing, const Eigen::Isometry3d& T_robot_camera)
    : device_{rtcNewDevice("threads=1")}, scene_{rtcNewScene(device_)} {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  const Eigen::Isometry3d T_camera_robot = T_robot_camera.inverse();
  for (const DrawnMesh& mesh : drawing.meshes) AddMesh(mesh, T_camera_robot);
  for (const DrawnRound& shape : drawing.rounds) AddRound(shape, T_camera_robot);
  rtcCommitScene(scene_);
}

EmbreeOracle::~EmbreeOracle() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeOracle::Attach(RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
}

void EmbreeOracle::AddMesh(const DrawnMesh& mesh, const Eigen::Isometry3d& T_camera_robot) {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  SetVertices(geometry, T_camera_robot * mesh.vertices_m);
  auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
      static_cast<std::size_t>(mesh.triangles.cols())));
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) {
    corners[i] = static_cast<unsigned>(mesh.triangles.data()[i]);
  }
  Attach(geometry);
}

void EmbreeOracle::AddRound(const DrawnRound& shape, const Eigen::Isometry3d& T_camera_robot) {
  const Eigen::Isometry3d T_camera_shape = T_camera_robot * shape.T_robot_shape;
  if (!shape.round_ends) {
    AddPrism(shape, T_camera_shape);
    return;
  }
  const bool sphere = shape.half_length_m == 0.0;
  RTCGeometry geometry = rtcNewGeometry(
      device_, sphere ? RTC_GEOMETRY_TYPE_SPHERE_POINT : RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  auto* ends = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), sphere ? 1 : 2));
  for (int end = 0; end < (sphere ? 1 : 2); ++end) {
    const Eigen::Vector3d center =
        T_camera_shape * Eigen::Vector3d(0.0, 0.0, (end == 0 ? -1.0 : 1.0) * shape.half_length_m);
    for (int k = 0; k < 3; ++k) ends[4 * end + k] = static_cast<float>(center[k]);
    ends[4 * end + 3] = static_cast<float>(shape.radius_m);
  }
  if (!sphere) {
    auto* first = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(unsigned), 1));
    *first = 0;
  }
  Attach(geometry);
}

void EmbreeOracle::AddPrism(const DrawnRound& shape, const Eigen::Isometry3d& T_camera_shape) {
  DrawnMesh prism;
  const Eigen::Index sides = kPrismSides;
  prism.vertices_m.resize(3, 2 * sides + 2);
  prism.triangles.resize(3, 4 * sides);
  // As much outside the circle as inside.
  const double radius = shape.radius_m * (1.0 + 0.25 * std::pow(M_PI / sides, 2));
  for (Eigen::Index i = 0; i < sides; ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(sides);
    const double x = radius * std::cos(angle);
    const double y = radius * std::sin(angle);
    prism.vertices_m.col(2 * i) << x, y, -shape.half_length_m;
    prism.vertices_m.col(2 * i + 1) << x, y, shape.half_length_m;
    const int low = static_cast<int>(2 * i);
    const int next = static_cast<int>(2 * ((i + 1) % sides));
    const int centers = static_cast<int>(2 * sides);
    prism.triangles.col(4 * i) << low, next, next + 1;
    prism.triangles.col(4 * i + 1) << low, next + 1, low + 1;
    prism.triangles.col(4 * i + 2) << centers, next, low;
    prism.triangles.col(4 * i + 3) << centers + 1, low + 1, next + 1;
  }
  prism.vertices_m.col(2 * sides) << 0.0, 0.0, -shape.half_length_m;
  prism.vertices_m.col(2 * sides + 1) << 0.0, 0.0, shape.half_length_m;
  AddMesh(prism, T_camera_shape);
}

double EmbreeOracle::Cast(const Eigen::Vector3d& ray, double nearest_m) const {
  RTCRayHit query = {};
  query.ray.dir_x = static_cast<float>(ray.x());
  query.ray.dir_y = static_cast<float>(ray.y());
  query.ray.dir_z = 1.0F;
  query.ray.tnear = static_cast<float>(nearest_m);
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_, &context, &query);
  const bool hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  return hit ? static_cast<double>(query.ray.tfar) : std::numeric_limits<double>::infinity();
}

Comparison CompareWithEmbree(const rgbd::RangeImage& range, const rgbd::CameraModel& camera,
                             const EmbreeOracle& oracle, double nearest_m) {
  Comparison result;
  for (int v = 0; v < range.height_px; ++v) {
    for (int u = 0; u < range.width_px; ++u) {
      const double drawn = static_cast<double>(*range.Pixel(u, v));
      const double z = std::isnan(drawn) ? std::numeric_limits<double>::infinity() : drawn;
      const auto cast = [&](double du, double dv) {
        return oracle.Cast(rgbd::Unproject(camera, {u + du, v + dv}), nearest_m);
      };
      const double wanted = cast(0.0, 0.0);
      result.pixels += std::isinf(wanted) ? 0 : 1;
      if (Agrees(z, wanted)) {
        if (!std::isinf(z)) result.largest_m = std::max(result.largest_m, std::abs(z - wanted));
        continue;
      }
      const bool near_edge = IsRightNearby(z, wanted, cast);
      ++(near_edge ? result.silhouette : result.wrong);
      if (!near_edge && result.first_wrong.empty()) {
        std::ostringstream text;
        text << "pixel (" << u << ", " << v << "): drawn " << z << " m, Embree " << wanted << " m";
        result.first_wrong = text.str();
      }
    }
  }
  return result;
}

}  // namespace palpate::virtual_camera
