// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"

namespace palpate::robot {

/// One scalar that is observed of the body, linear in its nodes: sum_k coefficients[k] .
/// x[nodes[k]]. A row of the paper's H_e: of a marker one for each axis, of a surface feature one
/// along its normal (the paper's W^N, eq. (10)).
struct ObservationRow {
  std::vector<int> nodes;  ///< rising, none twice
  std::vector<Eigen::Vector3d> coefficients;

  double Value(const Eigen::Ref<const Eigen::VectorXd>& x_m) const {
    double value = 0.0;
    for (size_t k = 0; k < nodes.size(); ++k) {
      value += coefficients[k].dot(x_m.segment<3>(3 * nodes[k]));
    }
    return value;
  }
};

/// The coordinate of a material point along `direction`.
ObservationRow RowOfPoint(const fem::InterpolationWeights& point, const Eigen::Vector3d& direction);

/// x, y and z of each point.
std::vector<ObservationRow> RowsOfPoints(const std::vector<fem::InterpolationWeights>& points);

}  // namespace palpate::robot
