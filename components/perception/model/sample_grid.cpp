// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/sample_grid.hpp"

#include <array>
#include <limits>

#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

class Search {
 public:
  explicit Search(SampleGrid* grid)
      : grid_(*grid), squared_m2_(grid->size(), std::numeric_limits<float>::max()) {
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      const int before = grid_.nearest[i];
      grid_.nearest[i] = SampleGrid::kNone;
      if (before != SampleGrid::kNone) Offer(i, before);
      if (grid_.site_m[i].z() > 0.0f) Offer(i, static_cast<int>(i));
    }
  }

  void Forward() {
    for (int row = 0; row < grid_.rows; ++row) {
      for (int column = 0; column < grid_.columns; ++column) {
        Compare(column, row, {{{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}});
      }
    }
  }
  void Backward() {
    for (int row = grid_.rows - 1; row >= 0; --row) {
      for (int column = grid_.columns - 1; column >= 0; --column) {
        Compare(column, row, {{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}});
      }
    }
  }

 private:
  using Offsets = std::array<std::array<int, 2>, 4>;

  void Compare(int column, int row, const Offsets& neighbours) {
    const std::size_t here = grid_.At(column, row);
    for (const auto& [right, down] : neighbours) {
      const int c = column + right, r = row + down;
      if (c < 0 || c >= grid_.columns || r < 0 || r >= grid_.rows) continue;
      const int candidate = grid_.nearest[grid_.At(c, r)];
      if (candidate != SampleGrid::kNone && candidate != grid_.nearest[here]) {
        Offer(here, candidate);
      }
    }
  }

  void Offer(std::size_t here, int candidate) {
    const Eigen::Vector3f& measured_m = grid_.measured_m[here];
    if (measured_m.z() <= 0.0f) {
      if (grid_.nearest[here] == SampleGrid::kNone) grid_.nearest[here] = candidate;
      return;
    }
    const float squared_m2 = (measured_m - grid_.site_m[At(candidate)]).squaredNorm();
    if (squared_m2 >= squared_m2_[here]) return;
    squared_m2_[here] = squared_m2;
    grid_.nearest[here] = candidate;
  }

  SampleGrid& grid_;
  std::vector<float> squared_m2_;
};

}  // namespace

void SampleGrid::Lay(int region_width_px, int region_height_px, int step) {
  step_px = step;
  columns = (region_width_px + step - 1) / step;
  rows = (region_height_px + step - 1) / step;
  const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  measured_m.assign(count, Eigen::Vector3f::Zero());
  site_m.assign(count, Eigen::Vector3f::Zero());
  normal.assign(count, Eigen::Vector3f::Zero());
  nearest.assign(count, kNone);
}

void FindNearestSites(SampleGrid* grid, int rounds) {
  Search search(grid);
  for (int round = 0; round < rounds; ++round) {
    search.Forward();
    search.Backward();
  }
}

}  // namespace palpate::perception
