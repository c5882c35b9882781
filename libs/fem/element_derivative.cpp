// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/element_derivative.hpp"

#include <array>

#include "libs/core/check.hpp"
#include "libs/fem/element_derivative_law.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

namespace {

using element_derivative::Dual;
using element_derivative::EvaluateStress;
using element_derivative::Matrix3;
using element_derivative::UnitStresses;
using element_derivative::VolumeRatio;

constexpr int kMaxNodes = 10;
constexpr int kMaxPoints = 4;

template <typename T>
using Columns = Eigen::Matrix<T, 3, kMaxNodes>;

size_t At(int value) { return static_cast<size_t>(value); }

template <typename T>
struct ElementForces {
  Columns<T> per_lambda = Columns<T>::Constant(T(0.0));
  Columns<T> per_mu = Columns<T>::Constant(T(0.0));
};

}  // namespace

/// One cell's data in the scalar type of the differentiation.
template <typename T>
struct ElementDerivative::Element {
  int nodes = 0;
  int points = 0;
  Columns<T> x;
  std::array<Columns<T>, kMaxPoints> gradients;
  std::array<T, kMaxPoints> weights;

  Matrix3<T> DeformationGradient(int q) const {
    Matrix3<T> F = Matrix3<T>::Constant(T(0.0));
    for (int a = 0; a < nodes; ++a) {
      F += x.col(a) * gradients[At(q)].col(a).transpose();
    }
    return F;
  }

  T MeanVolumeRatio(MaterialModel model) const {
    T volume(0.0);
    T deformed(0.0);
    for (int q = 0; q < points; ++q) {
      volume += weights[At(q)];
      deformed += weights[At(q)] * VolumeRatio(model, DeformationGradient(q));
    }
    return deformed / volume;
  }

  /// With mean dilatation lambda acts on the mean volume ratio, and mu on what the volume ratio of
  /// the point differs by: U = lambda V U1(mean J) + mu (sum w U1(J) - V U1(mean J)).
  ElementForces<T> Forces(const Material& material) const {
    const bool mean = material.volumetric == Volumetric::kMeanDilatation;
    const T mean_J = mean ? MeanVolumeRatio(material.model) : T(1.0);
    ElementForces<T> forces;
    for (int q = 0; q < points; ++q) {
      const Matrix3<T> F = DeformationGradient(q);
      UnitStresses<T> stress = EvaluateStress(material, F, VolumeRatio(material.model, F));
      if (mean) {
        const Matrix3<T> of_mean_J = EvaluateStress(material, F, mean_J).of_lambda;
        stress.of_mu += stress.of_lambda - of_mean_J;
        stress.of_lambda = of_mean_J;
      }
      const Matrix3<T> of_lambda = stress.of_lambda * weights[At(q)];
      const Matrix3<T> of_mu = stress.of_mu * weights[At(q)];
      for (int a = 0; a < nodes; ++a) {
        forces.per_lambda.col(a) += of_lambda * gradients[At(q)].col(a);
        forces.per_mu.col(a) += of_mu * gradients[At(q)].col(a);
      }
    }
    return forces;
  }
};

namespace {

/// Adds factor * dF_int of one cell, from its dual forces.
void ScatterSlopes(const TetMesh& mesh, int cell, const Material& material, double factor,
                   const ElementForces<Dual>& forces, Eigen::VectorXd& force_N) {
  const double lambda = factor * material.LameLambda_Pa();
  const double mu = factor * material.LameMu_Pa();
  for (Eigen::Index a = 0; a < mesh.cells.rows(); ++a) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      force_N[3 * mesh.cells(a, cell) + i] +=
          lambda * forces.per_lambda(i, a).slope + mu * forces.per_mu(i, a).slope;
    }
  }
}

}  // namespace

ElementDerivative::ElementDerivative(const TetMesh& mesh, std::vector<int> material_of_cell)
    : mesh_(mesh), material_of_cell_(std::move(material_of_cell)) {
  PALPATE_CHECK(material_of_cell_.size() == At(mesh_.CellCount()), material_of_cell_.size());
  const TetQuadrature rule = StiffnessQuadrature(mesh_.element_type());
  points_ = static_cast<int>(rule.weights.size());
  PALPATE_CHECK(points_ <= kMaxPoints, points_);
  gradients_.reserve(At(mesh_.CellCount()) * At(points_) * At(3 * kMaxNodes));
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

template <typename T>
ElementDerivative::Element<T> ElementDerivative::LoadElement(int cell,
                                                             const Eigen::VectorXd& x_m) const {
  Element<T> element;
  element.nodes = static_cast<int>(mesh_.cells.rows());
  element.points = points_;
  for (int a = 0; a < element.nodes; ++a) {
    element.x.col(a) = x_m.segment<3>(3 * mesh_.cells(a, cell)).template cast<T>();
  }
  for (int q = 0; q < points_; ++q) {
    const int place = cell * points_ + q;
    element.weights[At(q)] = T(weights_[At(place)]);
    const double* source = gradients_.data() + At(place) * At(3 * element.nodes);
    for (int a = 0; a < element.nodes; ++a) {
      element.gradients[At(q)].col(a) =
          Eigen::Map<const Eigen::Vector3d>(source + 3 * a).template cast<T>();
    }
  }
  return element;
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
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    if (!Moves(cell, dx_m)) continue;
    Element<Dual> element = LoadElement<Dual>(cell, x_m);
    for (int a = 0; a < element.nodes; ++a) {
      for (int i = 0; i < 3; ++i) element.x(i, a).slope = dx_m[3 * mesh_.cells(a, cell) + i];
    }
    const Material& material = MaterialOf(materials, cell);
    ScatterSlopes(mesh_, cell, material, factor, element.Forces(material), force_N);
  }
}

void ElementDerivative::AddAlongRestShape(const std::vector<Material>& materials,
                                          const Eigen::VectorXd& x_m, const Eigen::VectorXd& dX_m,
                                          double factor, Eigen::VectorXd& force_N) const {
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    if (!Moves(cell, dX_m)) continue;
    Element<Dual> element = LoadElement<Dual>(cell, x_m);
    const double* gradients = gradients_.data() + At(cell * points_) * At(3 * element.nodes);
    for (int q = 0; q < points_; ++q) {
      const Eigen::Map<const Eigen::Matrix3Xd> G(gradients + 3 * q * element.nodes, 3,
                                                 element.nodes);
      Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
      for (int a = 0; a < element.nodes; ++a) {
        M += dX_m.segment<3>(3 * mesh_.cells(a, cell)) * G.col(a).transpose();
      }
      for (int a = 0; a < element.nodes; ++a) {
        const Eigen::Vector3d dG = -M.transpose() * G.col(a);
        for (int i = 0; i < 3; ++i) element.gradients[At(q)](i, a).slope = dG[i];
      }
      element.weights[At(q)].slope = element.weights[At(q)].value * M.trace();
    }
    const Material& material = MaterialOf(materials, cell);
    ScatterSlopes(mesh_, cell, material, factor, element.Forces(material), force_N);
  }
}

void ElementDerivative::LameForces(const std::vector<Material>& materials,
                                   const Eigen::VectorXd& x_m, Eigen::MatrixXd* per_lambda_m2,
                                   Eigen::MatrixXd* per_mu_m2) const {
  const auto count = static_cast<Eigen::Index>(materials.size());
  per_lambda_m2->setZero(x_m.size(), count);
  per_mu_m2->setZero(x_m.size(), count);
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    const Element<double> element = LoadElement<double>(cell, x_m);
    const ElementForces<double> forces = element.Forces(MaterialOf(materials, cell));
    const int k = material_of_cell_[At(cell)];
    for (int a = 0; a < element.nodes; ++a) {
      const Eigen::Index row = 3 * mesh_.cells(a, cell);
      per_lambda_m2->col(k).segment<3>(row) += forces.per_lambda.col(a);
      per_mu_m2->col(k).segment<3>(row) += forces.per_mu.col(a);
    }
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
