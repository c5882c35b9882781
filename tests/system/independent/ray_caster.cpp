// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/independent/ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::test_support {

namespace {

// Sums of uniform numbers: the standard library's distributions differ between implementations.
double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

double Normal(std::mt19937_64& random) {
  const double u = 1.0 - Uniform(random);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * Uniform(random));
}

// 3 x 3 means of white noise, of standard deviation 1: neighbours of stereo depth agree.
std::vector<double> SmoothNoise(int width, int height, std::mt19937_64& random) {
  std::vector<double> white(static_cast<std::size_t>(width + 2) *
                            static_cast<std::size_t>(height + 2));
  for (double& value : white) value = Normal(random);
  std::vector<double> smooth;
  smooth.reserve(white.size());
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      double sum = 0.0;
      for (int k = 0; k < 9; ++k) {
        sum += white[static_cast<std::size_t>((v + k / 3) * (width + 2) + u + k % 3)];
      }
      smooth.push_back(sum / 3.0);
    }
  }
  return smooth;
}

}  // namespace

ColoredMesh Ball(const Eigen::Vector3d& centre_m, double radius_m, const Eigen::Vector3d& rgb) {
  constexpr int kRings = 48, kSectors = 96;
  ColoredMesh mesh{.vertices_m = {}, .triangles = {}, .color_rgb = rgb};
  for (int i = 0; i <= kRings; ++i) {
    const double theta = M_PI * i / kRings;
    for (int j = 0; j < kSectors; ++j) {
      const double phi = 2.0 * M_PI * j / kSectors;
      mesh.vertices_m.push_back(
          centre_m + radius_m * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                                std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  }
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const int a = i * kSectors + j, b = i * kSectors + (j + 1) % kSectors;
      mesh.triangles.push_back({a, a + kSectors, b});
      mesh.triangles.push_back({b, a + kSectors, b + kSectors});
    }
  }
  return mesh;
}

ColoredMesh Block(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m,
                  const Eigen::Vector3d& rgb) {
  ColoredMesh mesh{.vertices_m = {}, .triangles = {}, .color_rgb = rgb};
  for (int k = 0; k < 8; ++k) {
    mesh.vertices_m.emplace_back((k & 1) != 0 ? high_m.x() : low_m.x(),
                                 (k & 2) != 0 ? high_m.y() : low_m.y(),
                                 (k & 4) != 0 ? high_m.z() : low_m.z());
  }
  constexpr int kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

ColoredMesh Cylinder(const Eigen::Vector3d& base_m, double radius_m, double height_m,
                     const Eigen::Vector3d& rgb) {
  constexpr int kSides = 96;
  ColoredMesh mesh{.vertices_m = {}, .triangles = {}, .color_rgb = rgb};
  for (int j = 0; j < kSides; ++j) {
    const double phi = 2.0 * M_PI * j / kSides;
    const Eigen::Vector3d off(radius_m * std::cos(phi), radius_m * std::sin(phi), 0.0);
    mesh.vertices_m.push_back(base_m + off);
    mesh.vertices_m.push_back(base_m + off + height_m * Eigen::Vector3d::UnitZ());
  }
  mesh.vertices_m.push_back(base_m);
  mesh.vertices_m.push_back(base_m + height_m * Eigen::Vector3d::UnitZ());
  for (int j = 0; j < kSides; ++j) {
    const int low = 2 * j, next = 2 * ((j + 1) % kSides);
    mesh.triangles.push_back({low, next, next + 1});
    mesh.triangles.push_back({low, next + 1, low + 1});
    mesh.triangles.push_back({2 * kSides, next, low});
    mesh.triangles.push_back({2 * kSides + 1, low + 1, next + 1});
  }
  return mesh;
}

Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m) {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d forward = (target_m - eye_m).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  T_robot_camera.linear() << right, forward.cross(right), forward;
  T_robot_camera.translation() = eye_m;
  return T_robot_camera;
}

RayCaster::RayCaster(const std::vector<ColoredMesh>& meshes)
    : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  for (const ColoredMesh& mesh : meshes) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices_m.size()));
    for (const Eigen::Vector3d& vertex : mesh.vertices_m) {
      for (int axis = 0; axis < 3; ++axis) *points++ = static_cast<float>(vertex[axis]);
    }
    auto* corners = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
      for (const int corner : triangle) *corners++ = static_cast<unsigned>(corner);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    colors_.push_back(mesh.color_rgb);
  }
  rtcCommitScene(scene_);
}

RayCaster::~RayCaster() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

RayCaster::Hit RayCaster::Cast(const Eigen::Vector3d& origin_m,
                               const Eigen::Vector3d& direction) const {
  RTCRayHit query = {};
  query.ray.org_x = static_cast<float>(origin_m.x());
  query.ray.org_y = static_cast<float>(origin_m.y());
  query.ray.org_z = static_cast<float>(origin_m.z());
  query.ray.dir_x = static_cast<float>(direction.x());
  query.ray.dir_y = static_cast<float>(direction.y());
  query.ray.dir_z = static_cast<float>(direction.z());
  query.ray.tnear = 1e-4F;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {.distance = static_cast<double>(query.ray.tfar),
          .normal = Eigen::Vector3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z)
                        .cast<double>()
                        .normalized(),
          .mesh = query.hit.geomID};
}

CastImage RayCaster::Take(const PinholeCamera& camera, const DepthErrors& errors,
                          std::mt19937_64* random) const {
  const int width = camera.width_px, height = camera.height_px;
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const Eigen::Vector3d light = Eigen::Vector3d(0.4, -0.5, 1.0).normalized();
  CastImage image{.depth = std::vector<std::uint16_t>(count, 0),
                  .rgb = std::vector<std::uint8_t>(3 * count, 0)};
  std::vector<Hit> hits(count);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector3d ray((u - camera.cx_px) / camera.f_px, (v - camera.cy_px) / camera.f_px,
                                1.0);
      hits[static_cast<std::size_t>(v * width + u)] =
          Cast(camera.T_robot_camera.translation(), camera.T_robot_camera.linear() * ray);
    }
  }
  const std::vector<double> noise = SmoothNoise(width, height, *random);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const auto at = static_cast<std::size_t>(v * width + u);
      const double z_m = hits[at].distance;
      const double shade = 0.45 + 0.5 * std::abs(hits[at].normal.dot(light));
      for (std::size_t c = 0; c < 3; ++c) {
        const double value =
            z_m > 0.0 ? 255.0 * shade * colors_[hits[at].mesh][static_cast<Eigen::Index>(c)] : 0.0;
        image.rgb[3 * at + c] =
            static_cast<std::uint8_t>(std::clamp(value + 3.0 * Normal(*random), 0.0, 255.0));
      }
      // Stereo loses half of what lies at a depth edge.
      const auto z_at = [&](int du, int dv) {
        const int a = std::clamp(u + du, 0, width - 1), b = std::clamp(v + dv, 0, height - 1);
        return hits[static_cast<std::size_t>(b * width + a)].distance;
      };
      bool at_edge = false;
      for (int k = 0; k < 9; ++k) {
        at_edge = at_edge || std::abs(z_at(k % 3 - 1, k / 3 - 1) - z_m) > 0.02;
      }
      const bool lost = at_edge && Uniform(*random) < 0.5;
      if (!(z_m > 0.0) || lost) continue;
      const Eigen::Vector2d slope((u - camera.cx_px) / camera.f_px,
                                  (v - camera.cy_px) / camera.f_px);
      const double biased_m = z_m * (1.0 + errors.bias + errors.slopes.dot(slope));
      const double sigma_m = z_m * z_m * errors.subpixel_px / (camera.f_px * camera.baseline_m);
      const double units = (biased_m + sigma_m * noise[at]) / camera.unit_m;
      image.depth[at] = static_cast<std::uint16_t>(std::clamp(std::round(units), 0.0, 65535.0));
    }
  }
  return image;
}

}  // namespace palpate::test_support
