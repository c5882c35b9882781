// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/cloud_builder.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::perception {

std::int64_t CloudBuilder::Build(const Registration& registration, const RegisteredFrame& frame,
                                 const PixelRegion& region, Label label, rgbd::SensedCloud* cloud) {
  const std::int64_t pixels = FindBounds(region, label);
  int block_px2 = std::max(1, static_cast<int>((pixels + max_points_ - 1) / max_points_));
  GroupBlocks(registration, frame, region, label, block_px2);
  while (static_cast<int>(groups_.size()) > max_points_) {  // blocks that are not full
    GroupBlocks(registration, frame, region, label, ++block_px2);
  }
  Write(registration.camera(), cloud);
  return pixels - cloud->Count();
}

/// Of the pixels with this label; returns how many there are.
std::int64_t CloudBuilder::FindBounds(const PixelRegion& region, Label label) {
  bounds_ = {.left = region.width, .top = region.height, .right = 0, .bottom = 0};
  std::int64_t pixels = 0;
  for (int row = 0; row < region.height; ++row) {
    const Label* begin = region.label.data() + region.At(0, row);
    const Label* end = begin + region.width;
    const auto in_row = std::count(begin, end, label);
    if (in_row == 0) continue;
    pixels += in_row;
    bounds_.top = std::min(bounds_.top, row);
    bounds_.bottom = row + 1;
    bounds_.left = std::min(bounds_.left, static_cast<int>(std::find(begin, end, label) - begin));
    const Label* last = end;
    while (last[-1] != label) --last;
    bounds_.right = std::max(bounds_.right, static_cast<int>(last - begin));
  }
  return pixels;
}

void CloudBuilder::GroupBlocks(const Registration& registration, const RegisteredFrame& frame,
                               const PixelRegion& region, Label label, int block_px2) {
  groups_.clear();
  const int width_px = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(block_px2))));
  const int height_px = (block_px2 + width_px - 1) / width_px;
  const auto reach = static_cast<float>(width_px);
  for (int top = bounds_.top; top < bounds_.bottom; top += height_px) {
    const int bottom = std::min(bounds_.bottom, top + height_px);
    for (int left = bounds_.left; left < bounds_.right; left += width_px) {
      const int right = std::min(bounds_.right, left + width_px);
      const std::size_t first_of_block = groups_.size();
      for (int row = top; row < bottom; ++row) {
        for (int column = left; column < right; ++column) {
          const std::size_t at = region.At(column, row);
          if (region.label[at] != label) continue;
          const int u = region.u_begin + column, v = region.v_begin + row;
          AddPixel(region.z_m[at] * registration.Ray(u, v), reach * region.step_m[at],
                   frame.color.Pixel(u, v), first_of_block);
        }
      }
    }
  }
}

void CloudBuilder::AddPixel(const Eigen::Vector3f& point_m, float step_m, const std::uint8_t* rgb,
                            std::size_t first_of_block) {
  std::size_t k = first_of_block;
  while (k < groups_.size() && std::abs(groups_[k].first_z_m - point_m.z()) >= step_m) ++k;
  if (k == groups_.size()) groups_.emplace_back().first_z_m = point_m.z();
  Group& group = groups_[k];
  ++group.count;
  group.sum_m += point_m;
  group.sum_rgb += Eigen::Vector3i(rgb[0], rgb[1], rgb[2]);
}

void CloudBuilder::Write(const rgbd::RgbdCamera& camera, rgbd::SensedCloud* cloud) const {
  const auto count = ToIndex(groups_.size());
  cloud->points_m.resize(3, count);
  cloud->sigma_m.resize(count);
  cloud->colors_rgb.resize(3 * groups_.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Group& group = groups_[At(i)];
    const Eigen::Vector3f mean_m = group.sum_m / static_cast<float>(group.count);
    cloud->points_m.col(i) = mean_m;
    const double sigma_m = rgbd::DepthSigma_m(camera, noise_, static_cast<double>(mean_m.z()));
    cloud->sigma_m[i] =
        static_cast<float>(sigma_m / std::sqrt(rgbd::IndependentPixels(noise_, group.count)));
    for (int k = 0; k < 3; ++k) {
      cloud->colors_rgb[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(k)] =
          static_cast<std::uint8_t>(group.sum_rgb[k] / group.count);
    }
  }
}

}  // namespace palpate::perception
