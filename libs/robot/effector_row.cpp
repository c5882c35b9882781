// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/effector_row.hpp"

namespace palpate::robot {

EffectorRow RowOfPoint(const fem::NodeWeights& point, const Eigen::Vector3d& direction) {
  EffectorRow row;
  row.nodes = point.nodes;
  for (const double weight : point.weights) row.coefficients.push_back(weight * direction);
  return row;
}

std::vector<EffectorRow> RowsOfPoints(const std::vector<fem::NodeWeights>& points) {
  std::vector<EffectorRow> rows;
  for (const fem::NodeWeights& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      rows.push_back(RowOfPoint(point, Eigen::Vector3d::Unit(axis)));
    }
  }
  return rows;
}

}  // namespace palpate::robot
