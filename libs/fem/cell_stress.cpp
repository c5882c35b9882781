// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/cell_stress.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/fem/point_stress.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

namespace {

/// `s`: xx, yy, zz, xy, yz, zx, as PointStress has it.
Eigen::Matrix3d Unpack(const Eigen::Matrix<double, 6, 1>& s) {
  Eigen::Matrix3d S;
  S << s[0], s[3], s[5],  //
      s[3], s[1], s[4],   //
      s[5], s[4], s[2];
  return S;
}

double VonMises(const Eigen::Matrix3d& stress) {
  const Eigen::Matrix3d deviator = stress - stress.trace() / 3.0 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

double LargestStrain(const Eigen::Matrix3d& F) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squared_stretches(F.transpose() * F,
                                                                         Eigen::EigenvaluesOnly);
  return std::sqrt(squared_stretches.eigenvalues()[2]) - 1.0;
}

}  // namespace

CellStress EvaluateCellStress(const TetMesh& mesh, const std::vector<Material>& materials,
                              const std::vector<int>& material_of_cell,
                              const Eigen::VectorXd& x_m) {
  PALPATE_CHECK(x_m.size() == 3 * mesh.nodes_m.cols(), x_m.size(), mesh.nodes_m.cols());
  Eigen::Matrix<double, 6, Eigen::Dynamic> second_Pa;
  PointStress(mesh, material_of_cell)
      .Evaluate(materials, Eigen::VectorXd::Ones(mesh.CellCount()), x_m, &second_Pa);
  const TetQuadrature rule = StiffnessQuadrature(mesh.element_type());
  const Eigen::Index points = rule.weights.size();
  const Eigen::Map<const Eigen::Matrix3Xd> now_m(x_m.data(), 3, x_m.size() / 3);
  CellStress result{Eigen::VectorXd::Zero(mesh.CellCount()),
                    Eigen::VectorXd::Zero(mesh.CellCount())};
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const Eigen::Matrix3Xd rest_corners_m = mesh.nodes_m(Eigen::all, mesh.cells.col(cell));
    const Eigen::Matrix3Xd corners_m = now_m(Eigen::all, mesh.cells.col(cell));
    double volume_m3 = 0.0;
    for (Eigen::Index q = 0; q < points; ++q) {
      const Eigen::Matrix3Xd dN = ShapeGradients(mesh.element_type(), rule.points.col(q));
      const Eigen::Matrix3d jacobian_m = rest_corners_m * dN.transpose();
      const Eigen::Matrix3d F = corners_m * dN.transpose() * jacobian_m.inverse();
      const Eigen::Matrix3d S = Unpack(second_Pa.col(cell * points + q));
      const double weight_m3 = jacobian_m.determinant() * rule.weights[q];
      volume_m3 += weight_m3;
      result.von_mises_Pa[cell] += weight_m3 * VonMises(F * S * F.transpose() / F.determinant());
      result.largest_strain[cell] += weight_m3 * LargestStrain(F);
    }
    result.von_mises_Pa[cell] /= volume_m3;
    result.largest_strain[cell] /= volume_m3;
  }
  return result;
}

}  // namespace palpate::fem
