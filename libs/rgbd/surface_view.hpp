// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/rgbd/camera_model.hpp"

namespace palpate::rgbd {

/// Which part of a surface a camera sees in each pixel, by z-buffer. Triangles count as flat and
/// straight-edged in the image also where the lens distorts (they are small); triangles that reach
/// behind kNearest_m are left out. Both sides of a triangle hide what is behind.
class SurfaceView {
 public:
  static constexpr double kNearest_m = 0.01;
  static constexpr int kNothing = -1;

  explicit SurfaceView(const CameraModel& camera);

  /// `vertices_m` [3 x v] in the camera frame; `triangles` [3 x t]. Buffers are used again.
  void Look(const Eigen::Ref<const Eigen::Matrix3Xd>& vertices_m,
            const Eigen::Ref<const Eigen::Matrix3Xi>& triangles);

  const CameraModel& camera() const { return camera_; }
  /// Nearest triangle at the centre of the pixel, or kNothing.
  int Triangle(int u_px, int v_px) const { return triangle_[Index(u_px, v_px)]; }
  /// z of it, m; 0 where nothing is.
  float Z_m(int u_px, int v_px) const {
    const float inverse = inverse_z_[Index(u_px, v_px)];
    return inverse > 0.0f ? 1.0f / inverse : 0.0f;
  }
  /// Bounds of what was drawn, pixels, first and one past the last; empty: (0, 0, 0, 0).
  struct Bounds {
    int u_begin = 0;
    int v_begin = 0;
    int u_end = 0;
    int v_end = 0;
    bool empty() const { return u_begin >= u_end; }
  };
  const Bounds& bounds() const { return bounds_; }

 private:
  std::size_t Index(int u_px, int v_px) const {
    return static_cast<std::size_t>(v_px) * static_cast<std::size_t>(camera_.width_px) +
           static_cast<std::size_t>(u_px);
  }
  void Clear();
  void Draw(int triangle, const Eigen::Vector3i& corners);
  void Grow(int u_begin, int u_end, int v_begin, int v_end);

  CameraModel camera_;
  Bounds bounds_;
  std::vector<int> triangle_;
  std::vector<float> inverse_z_;
  Eigen::Matrix2Xd on_image_px_;
  Eigen::VectorXd vertex_inverse_z_;  ///< 0: too near
};

}  // namespace palpate::rgbd
