// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/point_stress.hpp"

#include <Eigen/LU>
#include <array>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/element_derivative_law.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

namespace {

constexpr size_t kMaxPoints = 4;

Eigen::Matrix3d Unpack(const Eigen::Matrix<double, 6, 1>& s) {
  Eigen::Matrix3d S;
  S << s[0], s[3], s[5],  //
      s[3], s[1], s[4],   //
      s[5], s[4], s[2];
  return S;
}

Eigen::Matrix<double, 6, 1> Pack(const Eigen::Matrix3d& S) {
  Eigen::Matrix<double, 6, 1> s;
  s << S(0, 0), S(1, 1), S(2, 2), 0.5 * (S(0, 1) + S(1, 0)), 0.5 * (S(1, 2) + S(2, 1)),
      0.5 * (S(2, 0) + S(0, 2));
  return s;
}

}  // namespace

PointStress::PointStress(const TetMesh& mesh, std::vector<int> material_of_cell)
    : cells_(mesh.cells),
      material_of_cell_(std::move(material_of_cell)),
      nodes_per_cell_(static_cast<int>(mesh.cells.rows())) {
  PALPATE_CHECK(material_of_cell_.size() == At(mesh.CellCount()), material_of_cell_.size());
  const TetQuadrature rule = StiffnessQuadrature(mesh.element_type());
  points_per_cell_ = static_cast<int>(rule.weights.size());
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Matrix3Xd corners(3, nodes_per_cell_);
    for (int a = 0; a < nodes_per_cell_; ++a) {
      corners.col(a) = mesh.nodes_m.col(mesh.cells(a, cell));
    }
    for (int q = 0; q < points_per_cell_; ++q) {
      const Eigen::Matrix3Xd dN = ShapeGradients(mesh.element_type(), rule.points.col(q));
      const Eigen::Matrix3d jacobian = corners * dN.transpose();
      const Eigen::Matrix3Xd gradients = jacobian.transpose().inverse() * dN;
      gradients_.insert(gradients_.end(), gradients.data(), gradients.data() + gradients.size());
      weights_.push_back(jacobian.determinant() * rule.weights[q]);
    }
  }
}

PointStress::CellNodes PointStress::NodesOf(int cell, const Eigen::VectorXd& x_m) const {
  CellNodes x(3, nodes_per_cell_);
  for (int a = 0; a < nodes_per_cell_; ++a) x.col(a) = x_m.segment<3>(3 * cells_(a, cell));
  return x;
}

void PointStress::Evaluate(const std::vector<Material>& materials,
                           const Eigen::VectorXd& factor_of_cell, const Eigen::VectorXd& x_m,
                           Eigen::Matrix<double, 6, Eigen::Dynamic>* stress_Pa) const {
  stress_Pa->resize(6, PointCount());
  for (int cell = 0; cell < cells_.cols(); ++cell) {
    const Material& material = materials[At(material_of_cell_[At(cell)])];
    const CellNodes x = NodesOf(cell, x_m);
    std::array<Eigen::Matrix3d, kMaxPoints> F;
    std::array<double, kMaxPoints> J;
    double volume = 0.0;
    double image_volume = 0.0;
    const int first = cell * points_per_cell_;
    for (int q = 0; q < points_per_cell_; ++q) {
      F[At(q)].noalias() = x.lazyProduct(GradientsAt(first + q).transpose());
      J[At(q)] = F[At(q)].determinant();
      volume += weights_[At(first + q)];
      image_volume += weights_[At(first + q)] * J[At(q)];
    }
    const bool averaged = material.volumetric == Volumetric::kMeanDilatation;
    for (int q = 0; q < points_per_cell_; ++q) {
      const auto P = element_derivative::EvaluateStress<double>(material, F[At(q)], J[At(q)]);
      const double lambda_Pa = material.LameLambda_Pa();
      const double mu_Pa = material.LameMu_Pa();
      Eigen::Matrix3d stress_at_Pa = mu_Pa * P.of_mu;
      if (averaged) {
        const auto mean =
            element_derivative::EvaluateStress<double>(material, F[At(q)], image_volume / volume);
        stress_at_Pa += (lambda_Pa - mu_Pa) * mean.of_lambda + mu_Pa * P.of_lambda;
      } else {
        stress_at_Pa += lambda_Pa * P.of_lambda;
      }
      stress_Pa->col(first + q) = factor_of_cell[cell] * Pack(F[At(q)].inverse() * stress_at_Pa);
    }
  }
}

void PointStress::SetMatrix(const Eigen::Matrix<double, 6, Eigen::Dynamic>& stress_Pa,
                            NodeMatrix* matrix) const {
  PALPATE_CHECK(stress_Pa.cols() == PointCount(), stress_Pa.cols(), PointCount());
  matrix->SetZero();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 10, 10> local(nodes_per_cell_,
                                                                         nodes_per_cell_);
  CellNodes stressed(3, nodes_per_cell_);
  for (int cell = 0; cell < cells_.cols(); ++cell) {
    local.setZero();
    for (int q = 0; q < points_per_cell_; ++q) {
      const int point = cell * points_per_cell_ + q;
      const Gradients gradients = GradientsAt(point);
      stressed.noalias() =
          (weights_[At(point)] * Unpack(stress_Pa.col(point))).lazyProduct(gradients);
      local.noalias() += gradients.transpose().lazyProduct(stressed);
    }
    matrix->AddCell(cell, local);
  }
}

void PointStress::AddForces(const Eigen::Matrix<double, 6, Eigen::Dynamic>& stress_Pa,
                            const Eigen::VectorXd& x_m, Eigen::VectorXd* force_N) const {
  PALPATE_CHECK(stress_Pa.cols() == PointCount(), stress_Pa.cols(), PointCount());
  CellNodes of_cell_N(3, nodes_per_cell_);
  for (int cell = 0; cell < cells_.cols(); ++cell) {
    const CellNodes x = NodesOf(cell, x_m);
    of_cell_N.setZero();
    for (int q = 0; q < points_per_cell_; ++q) {
      const int point = cell * points_per_cell_ + q;
      const Gradients gradients = GradientsAt(point);
      const Eigen::Matrix3d F = x.lazyProduct(gradients.transpose());
      const Eigen::Matrix3d P = weights_[At(point)] * F * Unpack(stress_Pa.col(point));
      of_cell_N.noalias() += P.lazyProduct(gradients);
    }
    for (int a = 0; a < nodes_per_cell_; ++a) {
      force_N->segment<3>(3 * cells_(a, cell)) += of_cell_N.col(a);
    }
  }
}

}  // namespace palpate::fem
