// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

#include "libs/experiment/cloud/point_cloud.hpp"

namespace palpate::experiment {

/// More points than this are no camera's, but a broken or hostile header.
inline constexpr std::uint64_t kMostPoints = 64'000'000;

/// Puts a cloud together point by point.
class CloudBuilder {
 public:
  CloudBuilder(std::uint64_t width, std::uint64_t height, bool colored);

  /// What is not finite becomes NaN as a whole.
  void Add(const Eigen::Vector3d& point_m);
  /// 0x..RRGGBB
  void AddColor(std::uint64_t bits);
  void AddColor(std::uint8_t red, std::uint8_t green, std::uint8_t blue);

  PointCloud Take();

 private:
  PointCloud cloud_;
  Eigen::Index next_ = 0;
};

/// Broken promise (PALPATE_CHECK) where width, height, points and colours do not fit together.
void CheckShape(const PointCloud& cloud);

}  // namespace palpate::experiment
