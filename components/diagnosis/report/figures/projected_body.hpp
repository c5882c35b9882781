// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "libs/plot/plot_area.hpp"

namespace palpate::diagnosis {

/// A straight view along one axis of the robot frame.
struct BodyView {
  int right = 0;     ///< axis to the right
  int up = 2;        ///< axis up
  int towards = 1;   ///< axis towards the viewer
  double sign = -1;  ///< of that axis: right x up = sign * towards
  std::string name;  ///< "from the front"
};

/// From above, from the front and from the side, the one that shows the most of `points_m` [3 x n]
/// first.
std::vector<BodyView> BodyViews(const Eigen::Matrix3Xd& points_m);

/// Draws the faces of a surface [3 x n] that look at the viewer, shaded. Finer ones than can be
/// seen are joined. `area`: in mm.
void DrawBody(const Eigen::Matrix3Xd& surface_m, const std::vector<std::array<int, 3>>& triangles,
              const BodyView& view, const plot::PlotArea& area, plot::SvgDocument* svg);

}  // namespace palpate::diagnosis
