// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace palpate::test_support {

/// A surface of one colour, robot frame, m.
struct ColoredMesh {
  std::vector<Eigen::Vector3d> vertices_m;
  std::vector<std::array<int, 3>> triangles;
  Eigen::Vector3d color_rgb = Eigen::Vector3d::Constant(0.5);
};

ColoredMesh Ball(const Eigen::Vector3d& centre_m, double radius_m, const Eigen::Vector3d& rgb);
ColoredMesh Block(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m,
                  const Eigen::Vector3d& rgb);
/// Upright, from its base on.
ColoredMesh Cylinder(const Eigen::Vector3d& base_m, double radius_m, double height_m,
                     const Eigen::Vector3d& rgb);

/// Pinhole camera without distortion; colour is registered to depth.
struct PinholeCamera {
  int width_px = 848, height_px = 480;
  double f_px = 425.0;
  double cx_px = 423.5, cy_px = 239.5;
  double unit_m = 1e-4;
  double baseline_m = 0.05;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};
Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m);

/// Errors of the depth: z is measured as z (1 + bias + slopes . (x / z, y / z)), with noise of
/// standard deviation z^2 subpixel_px / (f b).
struct DepthErrors {
  double bias = 0.002;
  Eigen::Vector2d slopes = {0.002, -0.003};
  double subpixel_px = 0.08;
};

struct CastImage {
  std::vector<std::uint16_t> depth;  ///< [height * width] in units
  std::vector<std::uint8_t> rgb;     ///< [3 * height * width]
};

/// Casts a ray for each pixel (Embree): shares no code with palpate's rasteriser and camera.
class RayCaster {
 public:
  explicit RayCaster(const std::vector<ColoredMesh>& meshes);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  struct Hit {
    double distance = -1.0;  ///< in lengths of the ray; negative: none
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    std::size_t mesh = 0;
  };
  Hit Cast(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction) const;
  CastImage Take(const PinholeCamera& camera, const DepthErrors& errors,
                 std::mt19937_64* random) const;

 private:
  std::vector<Eigen::Vector3d> colors_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace palpate::test_support
