// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mullins.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::fem {

double Damage(const MullinsLaw& law, double below_J_m3) {
  return 1.0 - std::erf(below_J_m3 / law.m_J_m3) / law.r;
}

double StepDamage(const MullinsLaw& law, const Eigen::VectorXd& density_J_m3,
                  Eigen::VectorXd* largest_J_m3, Eigen::VectorXd* damage) {
  double most_off = 0.0;
  *largest_J_m3 = largest_J_m3->cwiseMax(density_J_m3);
  for (Eigen::Index cell = 0; cell < density_J_m3.size(); ++cell) {
    double& eta = (*damage)[cell];
    const double below_J_m3 = (*largest_J_m3)[cell] - density_J_m3[cell];
    const double wanted = Damage(law, below_J_m3);
    const double below = below_J_m3 / law.m_J_m3;
    const double answer = 4.0 * std::numbers::inv_sqrtpi * std::exp(-below * below) *
                          density_J_m3[cell] / (law.r * law.m_J_m3 * eta);
    most_off = std::max(most_off, std::abs(wanted - eta));
    eta += (wanted - eta) / (1.0 + answer);
  }
  return most_off;
}

Eigen::VectorXd CellVolumes_m3(const TetMesh& mesh) {
  Eigen::VectorXd volume_m3(mesh.CellCount());
  for (Eigen::Index cell = 0; cell < volume_m3.size(); ++cell) {
    const Eigen::Vector3d origin_m = mesh.nodes_m.col(mesh.cells(0, cell));
    const auto edge_m = [&](int corner) -> Eigen::Vector3d {
      return mesh.nodes_m.col(mesh.cells(corner, cell)) - origin_m;
    };
    volume_m3[cell] = edge_m(1).cross(edge_m(2)).dot(edge_m(3)) / 6.0;
  }
  return volume_m3;
}

}  // namespace palpate::fem
