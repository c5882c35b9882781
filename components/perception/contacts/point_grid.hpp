// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "libs/core/index.hpp"

namespace palpate::perception {

/// Points sorted into the cells of a regular grid, for neighbour search. Rebuilt for each frame in
/// linear time; buffers are used again.
class PointGrid {
 public:
  /// `points_m` [3 x n] finite; `radius_m` > 0: about the radius of ForEachNear.
  void Build(const Eigen::Matrix3Xf& points_m, float radius_m);

  /// Calls visit(index, squared distance in m^2) for each point within `radius_m` of `place_m`,
  /// until visit returns false.
  template <typename Visit>
  void ForEachNear(const Eigen::Vector3f& place_m, float radius_m, Visit&& visit) const;

 private:
  static constexpr int kMostCells = 1 << 20;

  std::size_t CellOf(const Eigen::Vector3i& cell) const {
    return (static_cast<std::size_t>(cell.z()) * static_cast<std::size_t>(cells_.y()) +
            static_cast<std::size_t>(cell.y())) *
               static_cast<std::size_t>(cells_.x()) +
           static_cast<std::size_t>(cell.x());
  }
  void ChooseCells(const Eigen::Matrix3Xf& points_m, float radius_m);

  Eigen::Vector3f lower_m_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i cells_ = Eigen::Vector3i::Zero();  ///< number along x, y, z
  float per_cell_ = 1.0f;                            ///< 1 / edge of a cell, 1/m
  std::vector<int> first_;                           ///< [cells + 1] into the two below
  std::vector<int> index_;                           ///< [n] number of the point in Build
  Eigen::Matrix3Xf sorted_m_;                        ///< [3 x n] by cell
  std::vector<std::size_t> cell_of_point_;
};

template <typename Visit>
void PointGrid::ForEachNear(const Eigen::Vector3f& place_m, float radius_m, Visit&& visit) const {
  const Eigen::Array3f at = (place_m - lower_m_).array() * per_cell_;
  const float reach = radius_m * per_cell_;
  Eigen::Array3i begin;
  Eigen::Array3i end;  // last one included
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<float>(cells_[axis]);
    if (!(at[axis] + reach >= 0.0f && at[axis] - reach <= count)) return;
    begin[axis] = static_cast<int>(std::max(0.0f, at[axis] - reach));
    end[axis] = std::min(cells_[axis] - 1, static_cast<int>(at[axis] + reach));
  }
  for (int z = begin.z(); z <= end.z(); ++z) {
    for (int y = begin.y(); y <= end.y(); ++y) {
      const int last = first_[CellOf({end.x(), y, z}) + 1];
      for (int k = first_[CellOf({begin.x(), y, z})]; k < last; ++k) {
        const float squared_m2 = (sorted_m_.col(k) - place_m).squaredNorm();
        if (squared_m2 > radius_m * radius_m) continue;
        if (!visit(index_[At(k)], squared_m2)) return;
      }
    }
  }
}

/// Median distance of a cloud's points from their nearest neighbour, m; 0 for fewer than two
/// points. Does not depend on the order of the points.
float MedianSpacing_m(const Eigen::Matrix3Xf& points_m, PointGrid* grid);

}  // namespace palpate::perception
