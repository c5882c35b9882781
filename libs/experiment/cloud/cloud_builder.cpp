// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/cloud_builder.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::experiment {

CloudBuilder::CloudBuilder(std::uint64_t width, std::uint64_t height, bool colored) {
  PALPATE_CHECK(width * height <= kMostPoints, width, height);
  cloud_.width = static_cast<int>(width);
  cloud_.height = static_cast<int>(height);
  cloud_.points_m.resize(3, ToIndex(width * height));
  if (colored) cloud_.colors_rgb.reserve(3 * width * height);
}

void CloudBuilder::Add(const Eigen::Vector3d& point_m) {
  if (point_m.allFinite()) {
    cloud_.points_m.col(next_) = point_m;
  } else {
    cloud_.points_m.col(next_).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  ++next_;
}

void CloudBuilder::AddColor(std::uint64_t bits) {
  AddColor(static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
           static_cast<std::uint8_t>(bits));
}

void CloudBuilder::AddColor(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  cloud_.colors_rgb.insert(cloud_.colors_rgb.end(), {red, green, blue});
}

PointCloud CloudBuilder::Take() {
  PALPATE_CHECK(next_ == cloud_.points_m.cols(), next_, cloud_.points_m.cols());
  CheckShape(cloud_);
  return std::move(cloud_);
}

void CheckShape(const PointCloud& cloud) {
  const Eigen::Index points = cloud.points_m.cols();
  PALPATE_CHECK(Eigen::Index{cloud.width} * cloud.height == points, cloud.width, cloud.height,
                points);
  const auto colors = ToIndex(cloud.colors_rgb.size());
  PALPATE_CHECK(colors == 0 || colors == 3 * points, colors, points);
}

}  // namespace palpate::experiment
