// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::perception {

/// Measured points, and points of a surface ("sites"), at every `step_px`-th pixel of a part of the
/// image. z = 0: none.
struct SampleGrid {
  static constexpr int kNone = -1;

  int step_px = 1;
  int columns = 0;
  int rows = 0;
  std::vector<Eigen::Vector3f> measured_m;  ///< camera frame
  std::vector<Eigen::Vector3f> site_m;      ///< camera frame
  std::vector<Eigen::Vector3f> normal;      ///< of the sites, unit
  std::vector<int> nearest;                 ///< site next to the measured point; kNone

  /// Everything none.
  void Lay(int region_width_px, int region_height_px, int step);
  std::size_t At(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  std::size_t size() const { return measured_m.size(); }
};

/// Finds the site nearest to each measured point in space, by propagating candidates from sample to
/// sample over the image, from the nearest ones before. Exact to about one step after two rounds;
/// kNone only where there is no site at all. Samples without a measurement have a neighbour's.
void FindNearestSites(SampleGrid* grid, int rounds = 2);

}  // namespace palpate::perception
