// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/core/laws.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "libs/fem/kernels/kernel.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem::laws {

std::vector<Law> AllLaws() {
  std::vector<Law> laws;
  for (const MaterialModel model :
       {MaterialModel::kLinear, MaterialModel::kCorotational, MaterialModel::kStVenantKirchhoff,
        MaterialModel::kNeoHookean, MaterialModel::kStableNeoHookean, MaterialModel::kYeoh}) {
    for (const ElementType element : {ElementType::kTet4, ElementType::kTet10}) {
      laws.push_back({model, Volumetric::kPointwise, element});
      if (kernels::SupportsMeanDilatation(model)) {
        laws.push_back({model, Volumetric::kMeanDilatation, element});
      }
    }
  }
  return laws;
}

std::string Name(const Law& law) {
  return std::string(ToString(law.model)) +
         (law.element == ElementType::kTet4 ? "_tet4" : "_tet10") +
         (law.volumetric == Volumetric::kPointwise ? "_pointwise" : "_mean");
}

double EnergyDensity_Pa(const Material& material, const Eigen::Matrix3d& F) {
  const double lambda = material.LameLambda_Pa();
  const double mu = material.LameMu_Pa();
  const Eigen::Vector3d stretch = Eigen::JacobiSVD<Eigen::Matrix3d>(F).singularValues();
  const double J = F.determinant();
  switch (material.model) {
    case MaterialModel::kLinear: {
      const Eigen::Matrix3d strain = 0.5 * (F + F.transpose()) - Eigen::Matrix3d::Identity();
      return mu * strain.squaredNorm() + 0.5 * lambda * std::pow(strain.trace(), 2);
    }
    case MaterialModel::kCorotational:
      return mu * (stretch.array() - 1.0).square().sum() +
             0.5 * lambda * std::pow(stretch.sum() - 3.0, 2);
    case MaterialModel::kStVenantKirchhoff: {
      const Eigen::Array3d green = 0.5 * (stretch.array().square() - 1.0);
      return mu * green.square().sum() + 0.5 * lambda * std::pow(green.sum(), 2);
    }
    case MaterialModel::kNeoHookean:
      return 0.5 * mu * (stretch.squaredNorm() - 3.0) - mu * std::log(J) +
             0.5 * lambda * std::pow(std::log(J), 2);
    case MaterialModel::kStableNeoHookean:
      return 0.5 * mu * (stretch.squaredNorm() - 3.0) +
             0.5 * (lambda + mu) * std::pow(J - 1.0 - mu / (lambda + mu), 2);
    case MaterialModel::kYeoh: {
      const double c10 = 0.5 * mu;
      const double s = stretch.squaredNorm() / std::cbrt(J * J) - 3.0;
      return c10 * (s + material.c20_over_c10 * s * s + material.c30_over_c10 * s * s * s) +
             0.5 * (lambda + 2.0 / 3.0 * mu) * std::pow(J - 1.0, 2);
    }
  }
  return std::nan("");
}

Eigen::Matrix3d Stress_Pa(const Material& material, const Eigen::Matrix3d& F) {
  const double lambda = material.LameLambda_Pa();
  const double mu = material.LameMu_Pa();
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d C = F.transpose() * F;
  const double J = F.determinant();
  switch (material.model) {
    case MaterialModel::kLinear: {
      const Eigen::Matrix3d strain = 0.5 * (F + F.transpose()) - I;
      return 2.0 * mu * strain + lambda * strain.trace() * I;
    }
    case MaterialModel::kCorotational: {
      const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
      const Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
      return 2.0 * mu * (F - R) + lambda * (R.transpose() * F - I).trace() * R;
    }
    case MaterialModel::kStVenantKirchhoff: {
      const Eigen::Matrix3d green = 0.5 * (C - I);
      return F * (2.0 * mu * green + lambda * green.trace() * I);
    }
    case MaterialModel::kNeoHookean:
      return F * (mu * (I - C.inverse()) + lambda * std::log(J) * C.inverse());
    case MaterialModel::kStableNeoHookean: {
      const double alpha = 1.0 + mu / (lambda + mu);
      return F * (mu * I + (lambda + mu) * J * (J - alpha) * C.inverse());
    }
    case MaterialModel::kYeoh: {
      const double g = std::pow(J, -2.0 / 3.0);
      const double s = g * C.trace() - 3.0;
      const double twice_slope =
          mu * (1.0 + 2.0 * material.c20_over_c10 * s + 3.0 * material.c30_over_c10 * s * s);
      return F * (twice_slope * g * (I - C.trace() / 3.0 * C.inverse()) +
                  (lambda + 2.0 / 3.0 * mu) * J * (J - 1.0) * C.inverse());
    }
  }
  return Eigen::Matrix3d::Constant(std::nan(""));
}

Eigen::VectorXd RandomVector(Eigen::Index size, double amplitude, std::mt19937* engine) {
  Eigen::VectorXd values(size);
  for (double& value : values) {
    value = amplitude * (2.0 * static_cast<double>((*engine)()) / 4294967295.0 - 1.0);
  }
  return values;
}

Eigen::Matrix3d Rotation(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
}

TetMesh CrookedBox(ElementType element, const Eigen::Vector3i& counts) {
  const double brick_m = 0.01;
  std::mt19937 engine(11);
  TetMesh mesh = BoxMesh(brick_m * counts.cast<double>(), counts);
  mesh.nodes_m.reshaped() += RandomVector(mesh.nodes_m.size(), 0.1 * brick_m, &engine);
  if (element == ElementType::kTet4) return mesh;
  mesh = MakeQuadratic(mesh);
  mesh.nodes_m.reshaped() += RandomVector(mesh.nodes_m.size(), 0.02 * brick_m, &engine);
  return mesh;
}

}  // namespace palpate::fem::laws
