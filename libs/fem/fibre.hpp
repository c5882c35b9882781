// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/embedding.hpp"
#include "libs/fem/interpolation_weights.hpp"

namespace palpate::fem {

/// A point of a fibre at which its stretch is taken, and the length that it stands for. Within one
/// cell, so that fibres couple no nodes that cells do not.
struct FibrePoint {
  /// The fibre's direction sum_k weights[k] x[nodes[k]]: weights add up to 0, and give a unit
  /// vector for the rest positions that the fibre was laid on.
  InterpolationWeights direction;
  int cell = -1;
  double length_m = 0.0;  ///< on these rest positions, > 0
};

/// A line in the body that resists a change of its length.
struct EmbeddedFibre {
  std::vector<FibrePoint> points;
  /// EA: Young's modulus times cross-section, N, > 0.
  double axial_stiffness_N = 0.0;
  /// How far outside of the mesh its farthest piece lies, m, and where; 0: it is inside.
  double off_m = 0.0;
  Eigen::Vector3d off_at_m = Eigen::Vector3d::Zero();
};

/// Adds a polyline [3 x >= 2], rest positions, to `fibre`, cut where it passes from cell to cell.
/// Neighbouring points of the polyline differ. Pieces outside of the mesh are extrapolated in the
/// cell that PointLocator::Embed takes.
void AddPolyline(const PointLocator& locator, const Eigen::Matrix3Xd& path_m, EmbeddedFibre* fibre);

}  // namespace palpate::fem
