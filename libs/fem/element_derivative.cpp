// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/element_derivative.hpp"

#include <array>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/element_derivative_law.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

namespace {

using element_derivative::Dual;
using element_derivative::EvaluateStress;
using element_derivative::Matrix3;
using element_derivative::UnitStresses;
using element_derivative::VolumeRatio;

constexpr int kMaxPoints = 4;

/// An integration point: deformation gradient and rest volume, m^3.
template <typename T>
struct Point {
  Matrix3<T> F;
  T weight;
};

/// [points] first Piola-Kirchhoff stresses times rest volumes. With mean dilatation lambda acts on
/// the mean volume ratio, and mu on what the volume ratio of the point differs by:
/// U = lambda V U1(mean J) + mu (sum w U1(J) - V U1(mean J)).
template <typename T>
std::array<UnitStresses<T>, kMaxPoints> WeighedStresses(
    const Material& material, const std::array<Point<T>, kMaxPoints>& points, int count) {
  const bool mean = material.volumetric == Volumetric::kMeanDilatation;
  T volume(0.0);
  T deformed(0.0);
  for (int q = 0; q < count && mean; ++q) {
    volume += points[At(q)].weight;
    deformed += points[At(q)].weight * VolumeRatio(material.model, points[At(q)].F);
  }
  std::array<UnitStresses<T>, kMaxPoints> stresses;
  for (int q = 0; q < count; ++q) {
    const auto& [F, weight] = points[At(q)];
    UnitStresses<T>& stress = stresses[At(q)];
    stress = EvaluateStress(material, F, VolumeRatio(material.model, F));
    if (mean) {
      const Matrix3<T> of_mean_J = EvaluateStress(material, F, T(deformed / volume)).of_lambda;
      stress.of_mu += stress.of_lambda - of_mean_J;
      stress.of_lambda = of_mean_J;
    }
    stress.of_lambda *= weight;
    stress.of_mu *= weight;
  }
  return stresses;
}

Matrix3<Dual> ToDual(const Eigen::Matrix3d& value, const Eigen::Matrix3d& slope) {
  Matrix3<Dual> dual;
  for (int k = 0; k < 9; ++k) dual(k) = {value(k), slope(k)};
  return dual;
}

/// lambda of_lambda + mu of_mu.
Matrix3<Dual> Stress(const Material& material, const UnitStresses<Dual>& unit) {
  return unit.of_lambda * Dual(material.LameLambda_Pa()) + unit.of_mu * Dual(material.LameMu_Pa());
}

Eigen::Matrix3d SlopeOf(const Matrix3<Dual>& dual) {
  return dual.unaryExpr([](const Dual& one) { return one.slope; });
}

Eigen::Matrix3d ValueOf(const Matrix3<Dual>& dual) {
  return dual.unaryExpr([](const Dual& one) { return one.value; });
}

}  // namespace

template <int kNodes>
struct ElementDerivative::Cell {
  using Columns = Eigen::Matrix<double, 3, kNodes>;

  const ElementDerivative& of;
  int index;

  int Node(int a) const { return of.mesh_.cells(a, index); }
  double Weight(int point) const { return of.weights_[At(index * of.points_ + point)]; }
  Eigen::Map<const Columns> Gradients(int point) const {
    return Eigen::Map<const Columns>(of.gradients_.data() +
                                     At(index * of.points_ + point) * At(3 * kNodes));
  }
  Columns Gather(const Eigen::VectorXd& nodal) const {
    Columns columns;
    for (int a = 0; a < kNodes; ++a) columns.col(a) = nodal.segment<3>(3 * Node(a));
    return columns;
  }
  /// sum_a nodal_a G_a'.
  Eigen::Matrix3d GradientOf(const Columns& nodal, int point) const {
    return nodal.lazyProduct(Gradients(point).transpose());
  }
  void Scatter(const Columns& columns, Eigen::Ref<Eigen::VectorXd> nodal) const {
    for (int a = 0; a < kNodes; ++a) nodal.segment<3>(3 * Node(a)) += columns.col(a);
  }
};

ElementDerivative::ElementDerivative(const TetMesh& mesh, std::vector<int> material_of_cell)
    : mesh_(mesh), material_of_cell_(std::move(material_of_cell)) {
  PALPATE_CHECK(material_of_cell_.size() == At(mesh_.CellCount()), material_of_cell_.size());
  const TetQuadrature rule = StiffnessQuadrature(mesh_.element_type());
  points_ = static_cast<int>(rule.weights.size());
  PALPATE_CHECK(points_ <= kMaxPoints, points_);
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    Eigen::Matrix3Xd X(3, mesh_.cells.rows());
    for (Eigen::Index a = 0; a < X.cols(); ++a) X.col(a) = mesh_.nodes_m.col(mesh_.cells(a, cell));
    for (int q = 0; q < points_; ++q) {
      const Eigen::Matrix3Xd dN = ShapeGradients(mesh_.element_type(), rule.points.col(q));
      const Eigen::Matrix3d jacobian = X * dN.transpose();
      const Eigen::Matrix3Xd gradients = jacobian.transpose().inverse() * dN;
      gradients_.insert(gradients_.end(), gradients.data(), gradients.data() + gradients.size());
      weights_.push_back(jacobian.determinant() * rule.weights[q]);
    }
  }
}

const Material& ElementDerivative::MaterialOf(const std::vector<Material>& materials,
                                              int cell) const {
  return materials[At(material_of_cell_[At(cell)])];
}

bool ElementDerivative::Moves(int cell, const Eigen::VectorXd& nodal) const {
  for (Eigen::Index a = 0; a < mesh_.cells.rows(); ++a) {
    if (!nodal.segment<3>(3 * mesh_.cells(a, cell)).isZero(0.0)) return true;
  }
  return false;
}

void ElementDerivative::AddAlongPositions(const std::vector<Material>& materials,
                                          const Eigen::VectorXd& x_m, const Eigen::VectorXd& dx_m,
                                          double factor, Eigen::VectorXd& force_N) const {
  const bool linear = mesh_.element_type() == ElementType::kTet4;
  (this->*(linear ? &ElementDerivative::AlongPositions<4>
                  : &ElementDerivative::AlongPositions<10>))(materials, x_m, dx_m, factor, force_N);
}

template <int kNodes>
void ElementDerivative::AlongPositions(const std::vector<Material>& materials,
                                       const Eigen::VectorXd& x_m, const Eigen::VectorXd& dx_m,
                                       double factor, Eigen::VectorXd& force_N) const {
  std::array<Point<Dual>, kMaxPoints> points;
  for (int k = 0; k < mesh_.CellCount(); ++k) {
    if (!Moves(k, dx_m)) continue;
    const Cell<kNodes> cell{*this, k};
    const auto x = cell.Gather(x_m);
    const auto dx = cell.Gather(dx_m);
    for (int q = 0; q < points_; ++q) {
      points[At(q)] = {ToDual(cell.GradientOf(x, q), cell.GradientOf(dx, q)), Dual(cell.Weight(q))};
    }
    const Material& material = MaterialOf(materials, k);
    const auto stresses = WeighedStresses(material, points, points_);
    typename Cell<kNodes>::Columns forces = Cell<kNodes>::Columns::Zero();
    for (int q = 0; q < points_; ++q) {
      forces += SlopeOf(Stress(material, stresses[At(q)])).lazyProduct(cell.Gradients(q));
    }
    cell.Scatter(factor * forces, force_N);
  }
}

void ElementDerivative::AddAlongRestShape(const std::vector<Material>& materials,
                                          const Eigen::VectorXd& x_m, const Eigen::VectorXd& dX_m,
                                          double factor, Eigen::VectorXd& force_N) const {
  const bool linear = mesh_.element_type() == ElementType::kTet4;
  (this->*(linear ? &ElementDerivative::AlongRestShape<4>
                  : &ElementDerivative::AlongRestShape<10>))(materials, x_m, dX_m, factor, force_N);
}

template <int kNodes>
void ElementDerivative::AlongRestShape(const std::vector<Material>& materials,
                                       const Eigen::VectorXd& x_m, const Eigen::VectorXd& dX_m,
                                       double factor, Eigen::VectorXd& force_N) const {
  std::array<Point<Dual>, kMaxPoints> points;
  std::array<Eigen::Matrix3d, kMaxPoints> M;
  for (int k = 0; k < mesh_.CellCount(); ++k) {
    if (!Moves(k, dX_m)) continue;
    const Cell<kNodes> cell{*this, k};
    const auto x = cell.Gather(x_m);
    const auto dX = cell.Gather(dX_m);
    for (int q = 0; q < points_; ++q) {
      M[At(q)] = cell.GradientOf(dX, q);
      const Eigen::Matrix3d F = cell.GradientOf(x, q);
      const double weight = cell.Weight(q);
      points[At(q)] = {ToDual(F, -F * M[At(q)]), Dual(weight, weight * M[At(q)].trace())};
    }
    const Material& material = MaterialOf(materials, k);
    const auto stresses = WeighedStresses(material, points, points_);
    typename Cell<kNodes>::Columns forces = Cell<kNodes>::Columns::Zero();
    for (int q = 0; q < points_; ++q) {
      const Matrix3<Dual> stress = Stress(material, stresses[At(q)]);
      // Of the sum of w P G_a: the stresses change, and the G_a.
      const Eigen::Matrix3d change = SlopeOf(stress) - ValueOf(stress) * M[At(q)].transpose();
      forces += change.lazyProduct(cell.Gradients(q));
    }
    cell.Scatter(factor * forces, force_N);
  }
}

void ElementDerivative::LameForces(const std::vector<Material>& materials,
                                   const Eigen::VectorXd& x_m, Eigen::MatrixXd* per_lambda_m2,
                                   Eigen::MatrixXd* per_mu_m2) const {
  const auto count = ToIndex(materials.size());
  per_lambda_m2->setZero(x_m.size(), count);
  per_mu_m2->setZero(x_m.size(), count);
  const bool linear = mesh_.element_type() == ElementType::kTet4;
  (this->*(linear ? &ElementDerivative::LameForcesOf<4> : &ElementDerivative::LameForcesOf<10>))(
      materials, x_m, per_lambda_m2, per_mu_m2);
}

template <int kNodes>
void ElementDerivative::LameForcesOf(const std::vector<Material>& materials,
                                     const Eigen::VectorXd& x_m, Eigen::MatrixXd* per_lambda_m2,
                                     Eigen::MatrixXd* per_mu_m2) const {
  std::array<Point<double>, kMaxPoints> points;
  for (int k = 0; k < mesh_.CellCount(); ++k) {
    const Cell<kNodes> cell{*this, k};
    const auto x = cell.Gather(x_m);
    for (int q = 0; q < points_; ++q) {
      points[At(q)] = {cell.GradientOf(x, q), cell.Weight(q)};
    }
    const auto stresses = WeighedStresses(MaterialOf(materials, k), points, points_);
    typename Cell<kNodes>::Columns of_lambda = Cell<kNodes>::Columns::Zero();
    typename Cell<kNodes>::Columns of_mu = of_lambda;
    for (int q = 0; q < points_; ++q) {
      of_lambda += stresses[At(q)].of_lambda.lazyProduct(cell.Gradients(q));
      of_mu += stresses[At(q)].of_mu.lazyProduct(cell.Gradients(q));
    }
    const int material = material_of_cell_[At(k)];
    cell.Scatter(of_lambda, per_lambda_m2->col(material));
    cell.Scatter(of_mu, per_mu_m2->col(material));
  }
}

Eigen::VectorXd ElementDerivative::NodalVolumeAlong(const Eigen::VectorXd& dX_m) const {
  const TetQuadrature rule = FineQuadrature();
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(mesh_.NodeCount());
  const Eigen::Index nodes = mesh_.cells.rows();
  Eigen::Matrix3Xd X(3, nodes);
  Eigen::Matrix3Xd dX(3, nodes);
  for (int q = 0; q < rule.weights.size(); ++q) {
    const Eigen::Matrix3Xd dN = ShapeGradients(mesh_.element_type(), rule.points.col(q));
    const Eigen::VectorXd N = ShapeFunctions(mesh_.element_type(), rule.points.col(q));
    for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
      for (Eigen::Index a = 0; a < nodes; ++a) {
        X.col(a) = mesh_.nodes_m.col(mesh_.cells(a, cell));
        dX.col(a) = dX_m.segment<3>(3 * mesh_.cells(a, cell));
      }
      const Eigen::Matrix3d cofactor =
          element_derivative::Cofactor<double>(Eigen::Matrix3d(X * dN.transpose()));
      const double change = cofactor.cwiseProduct(dX * dN.transpose()).sum();
      for (Eigen::Index a = 0; a < nodes; ++a) {
        volume[mesh_.cells(a, cell)] += rule.weights[q] * change * N[a];
      }
    }
  }
  return volume;
}

Eigen::VectorXd ElementDerivative::NodalVolume_m3(int material) const {
  Eigen::VectorXd counts(mesh_.CellCount());
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    counts[cell] = material < 0 || material_of_cell_[At(cell)] == material ? 1.0 : 0.0;
  }
  return ConsistentNodalMass_kg(mesh_, counts);
}

}  // namespace palpate::fem
