// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/z_buffer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::virtual_camera {

namespace {

using kernels::kRowPadding;

// The least whole number >= x and the one after the greatest <= x, within [0, count].
int FirstFrom(double x, int count) {
  return static_cast<int>(std::ceil(std::clamp(x, 0.0, static_cast<double>(count))));
}
int EndAfter(double x, int count) {
  return static_cast<int>(std::floor(std::clamp(x, -1.0, count - 1.0))) + 1;
}

}  // namespace

ZBuffer::ZBuffer(const rgbd::CameraModel& camera, const kernels::Kernels& loops)
    : camera_{camera}, loops_{loops} {
  PALPATE_CHECK(camera.width_px > 0 && camera.height_px > 0, camera.width_px, camera.height_px);
  PALPATE_CHECK(camera.fx_px > 0.0 && camera.fy_px > 0.0, camera.fx_px, camera.fy_px);
  stride_ = (camera.width_px + kRowPadding - 1) / kRowPadding * kRowPadding + 2 * kRowPadding;
  const auto pixels = static_cast<std::size_t>(stride_) *  //
                      static_cast<std::size_t>(camera.height_px);
  inverse_z_.assign(pixels, 0.0F);
  surface_.assign(pixels, 0);
  inverse_ray_length_.assign(pixels, 1.0F);
  if (camera.distorted()) {
    LayDistortedRays();
  } else {
    LayPinholeRays();
  }
}

void ZBuffer::LayPinholeRays() {
  canvas_scale_ = {camera_.fx_px, camera_.fy_px};
  canvas_offset_ = {camera_.cx_px, camera_.cy_px};
  canvas_min_ = {0.0, 0.0};
  canvas_max_ = {camera_.width_px - 1.0, camera_.height_px - 1.0};
  const auto row = static_cast<std::size_t>(stride_);
  x_.assign(row, 0.0F);
  y_.assign(row, 0.0F);
  column_x_.assign(row, 0.0);
  for (int u = 0; u < camera_.width_px; ++u) {
    const double x = (u - camera_.cx_px) / camera_.fx_px;
    column_x_[At(u)] = x;
    x_[At(u + kRowPadding)] = static_cast<float>(x);
    for (int v = 0; v < camera_.height_px; ++v) {
      const double y = (v - camera_.cy_px) / camera_.fy_px;
      inverse_ray_length_[Offset(v) + static_cast<std::size_t>(u)] =
          static_cast<float>(1.0 / std::sqrt(x * x + y * y + 1.0));
    }
  }
}

void ZBuffer::LayDistortedRays() {
  canvas_scale_.setOnes();
  canvas_offset_.setZero();
  x_.assign(inverse_z_.size(), 0.0F);
  y_.assign(inverse_z_.size(), 0.0F);
  std::vector<Eigen::Vector2d> rays;
  std::vector<int> pixels;
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      const Eigen::Vector3d ray = rgbd::Unproject(camera_, Eigen::Vector2d(u, v));
      if (!ray.allFinite()) continue;
      const std::size_t place = Offset(v) + static_cast<std::size_t>(u);
      x_[place] = static_cast<float>(ray.x());
      y_[place] = static_cast<float>(ray.y());
      inverse_ray_length_[place] = static_cast<float>(1.0 / ray.norm());
      rays.emplace_back(ray.head<2>());
      pixels.push_back(v * camera_.width_px + u);
    }
  }
  SortIntoCells(rays, pixels);
}

void ZBuffer::SortIntoCells(const std::vector<Eigen::Vector2d>& rays,
                            const std::vector<int>& pixels) {
  canvas_min_.setZero();
  canvas_max_.setZero();
  for (const Eigen::Vector2d& ray : rays) {
    canvas_min_ = canvas_min_.min(ray.array());
    canvas_max_ = canvas_max_.max(ray.array());
  }
  cells_.size = 1.0 / std::max(camera_.fx_px, camera_.fy_px);
  cells_.first_x = canvas_min_.x() - 0.5 * cells_.size;
  cells_.first_y = canvas_min_.y() - 0.5 * cells_.size;
  const Eigen::Array2d extent = (canvas_max_ - canvas_min_) / cells_.size;
  cells_.columns = static_cast<int>(extent.x()) + 2;
  cells_.rows = static_cast<int>(extent.y()) + 2;
  const auto cell_of = [this](const Eigen::Vector2d& ray) {
    const int column = static_cast<int>((ray.x() - cells_.first_x) / cells_.size);
    const int row = static_cast<int>((ray.y() - cells_.first_y) / cells_.size);
    return static_cast<std::size_t>(row * cells_.columns + column);
  };
  const auto cell_count = static_cast<std::size_t>(cells_.rows * cells_.columns);
  cells_.begin.assign(cell_count + 1, 0);
  for (const Eigen::Vector2d& ray : rays) ++cells_.begin[cell_of(ray) + 1];
  std::partial_sum(cells_.begin.begin(), cells_.begin.end(), cells_.begin.begin());
  std::vector<int> next(cells_.begin.begin(), cells_.begin.end() - 1);
  const std::size_t padded = rays.size() + kRowPadding;
  cells_.x.assign(padded, 0.0);
  cells_.y.assign(padded, 0.0);
  cells_.inverse_z.assign(padded, 0.0F);
  cells_.surface.assign(padded, 0);
  cells_.place.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto slot = static_cast<std::size_t>(next[cell_of(rays[i])]++);
    cells_.x[slot] = rays[i].x();
    cells_.y[slot] = rays[i].y();
    cells_.place[slot] = Offset(pixels[i] / camera_.width_px) +
                         static_cast<std::size_t>(pixels[i] % camera_.width_px);
  }
}

kernels::RayCanvas ZBuffer::CellCanvas() {
  return {.first_x = cells_.first_x,
          .first_y = cells_.first_y,
          .cell = cells_.size,
          .columns = cells_.columns,
          .rows = cells_.rows,
          .begin = cells_.begin.data(),
          .x = cells_.x.data(),
          .y = cells_.y.data(),
          .inverse_z = cells_.inverse_z.data(),
          .surface = cells_.surface.data()};
}

void ZBuffer::Clear() {
  std::fill(inverse_z_.begin(), inverse_z_.end(), 0.0F);
  std::fill(surface_.begin(), surface_.end(), 0U);
  std::fill(cells_.inverse_z.begin(), cells_.inverse_z.end(), 0.0F);
  std::fill(cells_.surface.begin(), cells_.surface.end(), 0U);
}

void ZBuffer::Draw(const std::vector<kernels::FlatTriangle>& triangles) {
  const int count = static_cast<int>(triangles.size());
  if (camera_.distorted()) {
    loops_.fill_triangles_by_ray(triangles.data(), count, CellCanvas());
    return;
  }
  const kernels::Canvas canvas = {.width_px = camera_.width_px,
                                  .height_px = camera_.height_px,
                                  .stride = stride_,
                                  .inverse_z = inverse_z_.data() + kRowPadding,
                                  .surface = surface_.data() + kRowPadding};
  loops_.fill_triangles(triangles.data(), count, canvas);
}

void ZBuffer::Draw(const kernels::RoundSurface& shape, std::uint32_t surface,
                   const Eigen::Array2d& min, const Eigen::Array2d& max) {
  if (camera_.distorted()) {
    const int first_column = FirstFrom((min.x() - cells_.first_x) / cells_.size - 1.0,  //
                                       cells_.columns);
    const int end_column = EndAfter((max.x() - cells_.first_x) / cells_.size, cells_.columns);
    const int first_row = FirstFrom((min.y() - cells_.first_y) / cells_.size - 1.0, cells_.rows);
    const int end_row = EndAfter((max.y() - cells_.first_y) / cells_.size, cells_.rows);
    for (int row = first_row; row < end_row && first_column < end_column; ++row) {
      const int* begin = cells_.begin.data() + row * cells_.columns;
      const int first = begin[first_column];
      loops_.fill_round(shape, surface,
                        {.x = cells_.x.data() + first,
                         .y = cells_.y.data() + first,
                         .row_y = 0.0,
                         .count = begin[end_column] - first,
                         .inverse_z = cells_.inverse_z.data() + first,
                         .surface = cells_.surface.data() + first});
    }
    return;
  }
  const Eigen::Array2d low = canvas_scale_ * min + canvas_offset_;
  const Eigen::Array2d high = canvas_scale_ * max + canvas_offset_;
  const int first = FirstFrom(low.x(), camera_.width_px);
  const int end = EndAfter(high.x(), camera_.width_px);
  for (int v = FirstFrom(low.y(), camera_.height_px); v < EndAfter(high.y(), camera_.height_px);
       ++v) {
    const std::size_t place = Offset(v) + static_cast<std::size_t>(first);
    loops_.fill_round(shape, surface,
                      {.x = column_x_.data() + first,
                       .y = nullptr,
                       .row_y = (v - camera_.cy_px) / camera_.fy_px,
                       .count = end - first,
                       .inverse_z = inverse_z_.data() + place,
                       .surface = surface_.data() + place});
  }
}

void ZBuffer::Finish() {
  for (std::size_t slot = 0; slot < cells_.place.size(); ++slot) {
    inverse_z_[cells_.place[slot]] = cells_.inverse_z[slot];
    surface_[cells_.place[slot]] = cells_.surface[slot];
  }
}

kernels::RowOfSurfaces ZBuffer::Row(int v) {
  const std::size_t place = Offset(v);
  if (!camera_.distorted() && v != row_of_y_) {
    std::fill(y_.begin(), y_.end(), static_cast<float>((v - camera_.cy_px) / camera_.fy_px));
    row_of_y_ = v;
  }
  const std::size_t ray_place = camera_.distorted() ? place : kRowPadding;
  return {.x = x_.data() + ray_place,
          .y = y_.data() + ray_place,
          .inverse_z = inverse_z_.data() + place,
          .surface = surface_.data() + place,
          .count = camera_.width_px};
}

}  // namespace palpate::virtual_camera
