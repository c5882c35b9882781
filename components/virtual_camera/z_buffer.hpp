// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/virtual_camera/kernels/kernels.hpp"
#include "libs/rgbd/camera_model.hpp"

namespace palpate::virtual_camera {

/// What is nearest in each pixel of one camera. A lens that distorts is met exactly: the pixels'
/// own rays are tested, in the normalised image. Where Unproject cannot say what a pixel sees, it
/// sees nothing.
class ZBuffer {
 public:
  /// `loops` must outlive this.
  ZBuffer(const rgbd::CameraModel& camera, const kernels::Kernels& loops);

  const rgbd::CameraModel& camera() const { return camera_; }

  /// Triangles are drawn in the plane of the canvas: canvas = scale * (x, y) + offset of the
  /// normalised image.
  const Eigen::Array2d& canvas_scale() const { return canvas_scale_; }
  const Eigen::Array2d& canvas_offset() const { return canvas_offset_; }
  /// Triangles that lie wholly outside these bounds of the canvas (lower, upper) cannot be seen.
  const Eigen::Array2d& canvas_min() const { return canvas_min_; }
  const Eigen::Array2d& canvas_max() const { return canvas_max_; }

  void Clear();
  void Draw(const std::vector<kernels::FlatTriangle>& triangles);
  /// `min` and `max` bound the shape in the normalised image; infinite: all of it.
  void Draw(const kernels::RoundSurface& shape, std::uint32_t surface, const Eigen::Array2d& min,
            const Eigen::Array2d& max);
  /// After the last Draw: what Row shows is up to date.
  void Finish();

  /// A row of pixels; holds until the next call. Padding of kRowPadding on both sides.
  kernels::RowOfSurfaces Row(int v);
  const float* InverseZ(int v) const { return inverse_z_.data() + Offset(v); }
  /// 1/|(x, y, 1)| of each pixel of a row, padded likewise.
  const float* InverseRayLength(int v) const { return inverse_ray_length_.data() + Offset(v); }

 private:
  struct Cells {  // of a camera with distortion
    double first_x = 0.0;
    double first_y = 0.0;
    double size = 1.0;
    int columns = 0;
    int rows = 0;
    std::vector<int> begin;
    std::vector<std::size_t> place;  // [pixels] in the padded rows
    std::vector<double> x;
    std::vector<double> y;
    std::vector<float> inverse_z;
    std::vector<std::uint32_t> surface;
  };

  std::size_t Offset(int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(stride_) + kernels::kRowPadding;
  }
  void LayPinholeRays();
  void LayDistortedRays();
  void SortIntoCells(const std::vector<Eigen::Vector2d>& rays, const std::vector<int>& pixels);
  kernels::RayCanvas CellCanvas();

  rgbd::CameraModel camera_;
  const kernels::Kernels& loops_;
  int stride_;
  Eigen::Array2d canvas_scale_;
  Eigen::Array2d canvas_offset_;
  Eigen::Array2d canvas_min_;
  Eigen::Array2d canvas_max_;
  std::vector<float> inverse_z_;
  std::vector<std::uint32_t> surface_;
  std::vector<float> inverse_ray_length_;
  std::vector<float> x_;          // one row, or with distortion all
  std::vector<float> y_;          // likewise
  int row_of_y_ = -1;             // without distortion
  std::vector<double> column_x_;  // without distortion
  Cells cells_;
};

}  // namespace palpate::virtual_camera
