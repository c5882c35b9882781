// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/point_grid.hpp"

#include <cmath>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

void PointGrid::ChooseCells(const Eigen::Matrix3Xf& points_m, float radius_m) {
  lower_m_ = points_m.rowwise().minCoeff();
  const Eigen::Vector3d size_m = (points_m.rowwise().maxCoeff() - lower_m_).cast<double>();
  double edge_m = static_cast<double>(radius_m);
  Eigen::Array3d count;
  const auto count_cells = [&] { count = (size_m.array() / edge_m).floor() + 1.0; };
  for (count_cells(); count.prod() > kMostCells; count_cells()) edge_m *= 1.25;
  cells_ = count.cast<int>();
  per_cell_ = static_cast<float>(1.0 / edge_m);
}

void PointGrid::Build(const Eigen::Matrix3Xf& points_m, float radius_m) {
  PALPATE_CHECK(radius_m > 0.0f, radius_m);
  const auto count = static_cast<std::size_t>(points_m.cols());
  cells_.setZero();
  if (count == 0) return;
  ChooseCells(points_m, radius_m);
  first_.assign(static_cast<std::size_t>(cells_.prod()) + 1, 0);
  cell_of_point_.resize(count);
  const Eigen::Vector3i last = cells_.array() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f at = (points_m.col(ToIndex(i)) - lower_m_) * per_cell_;
    cell_of_point_[i] = CellOf(at.cast<int>().cwiseMin(last));
    ++first_[cell_of_point_[i] + 1];
  }
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  index_.resize(count);
  sorted_m_.resize(3, points_m.cols());
  for (std::size_t i = count; i-- > 0;) {  // first_ moves down to where each cell begins
    const int place = --first_[cell_of_point_[i] + 1];
    index_[At(place)] = static_cast<int>(i);
    sorted_m_.col(place) = points_m.col(ToIndex(i));
  }
  // Now first_[cell + 1] is the begin of `cell`: shift back.
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) first_[cell] = first_[cell + 1];
  first_.back() = static_cast<int>(count);
}

float MedianSpacing_m(const Eigen::Matrix3Xf& points_m, PointGrid* grid) {
  const Eigen::Index count = points_m.cols();
  if (count < 2) return 0.0f;
  const Eigen::Vector3f size_m = points_m.rowwise().maxCoeff() - points_m.rowwise().minCoeff();
  const float largest_m = std::max(size_m.norm(), 1e-6f);
  std::vector<float> nearest_m2(static_cast<std::size_t>(count));
  const auto median = nearest_m2.begin() + count / 2;
  // Spacing of a surface of that size with as many points. Distances beyond the radius stay
  // unknown, without effect on the median as long as it is below.
  for (float radius_m = 0.5f * largest_m / std::sqrt(static_cast<float>(count));;
       radius_m *= 2.0f) {
    grid->Build(points_m, radius_m);
    for (Eigen::Index i = 0; i < count; ++i) {
      float nearest = std::numeric_limits<float>::infinity();
      grid->ForEachNear(points_m.col(i), radius_m, [&](int other, float squared_m2) {
        if (other != i) nearest = std::min(nearest, squared_m2);
        return true;
      });
      nearest_m2[At(i)] = nearest;
    }
    std::nth_element(nearest_m2.begin(), median, nearest_m2.end());
    if (std::isfinite(*median) || radius_m > largest_m) return std::sqrt(*median);
  }
}

}  // namespace palpate::perception
