// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/observation_row.hpp"

namespace palpate::robot {

ObservationRow RowOfPoint(const fem::InterpolationWeights& point,
                          const Eigen::Vector3d& direction) {
  ObservationRow row;
  row.nodes = point.nodes;
  for (const double weight : point.weights) row.coefficients.push_back(weight * direction);
  return row;
}

std::vector<ObservationRow> RowsOfPoints(const std::vector<fem::InterpolationWeights>& points) {
  std::vector<ObservationRow> rows;
  for (const fem::InterpolationWeights& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      rows.push_back(RowOfPoint(point, Eigen::Vector3d::Unit(axis)));
    }
  }
  return rows;
}

}  // namespace palpate::robot
