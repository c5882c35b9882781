// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>
#include <string>
#include <vector>

#include "libs/fem/material.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem::laws {

/// One way to compute an element.
struct Law {
  MaterialModel model;
  Volumetric volumetric;
  ElementType element;
};

/// Every material with both elements and each volumetric treatment that it supports.
std::vector<Law> AllLaws();
/// "stable_neo_hookean_tet10_mean"
std::string Name(const Law& law);

/// Elastic energy for each rest volume, Pa, without the constant that makes it zero at rest or not:
/// from the stress formulas in material.hpp, by principal stretches, apart from the kernels.
double EnergyDensity_Pa(const Material& material, const Eigen::Matrix3d& F);
/// First Piola-Kirchhoff stress, Pa, from the same formulas (P = F S).
Eigen::Matrix3d Stress_Pa(const Material& material, const Eigen::Matrix3d& F);

/// Entries uniform in [-amplitude, amplitude]; the same on every machine.
Eigen::VectorXd RandomVector(Eigen::Index size, double amplitude, std::mt19937* engine);
Eigen::Matrix3d Rotation(double angle_rad, const Eigen::Vector3d& axis);

/// A box with corner nodes moved at random; tet10 has curved edges.
TetMesh CrookedBox(ElementType element, const Eigen::Vector3i& counts);

/// `function(x + h d)` differentiated along d to fourth order (Richardson's extrapolation of
/// central differences).
template <typename Function>
auto DerivativeAlong(const Function& function, const Eigen::VectorXd& x, const Eigen::VectorXd& d,
                     double h) {
  const auto at = [&](double t) { return function(Eigen::VectorXd(x + t * d)); };
  using Value = decltype(function(x));
  const Value value = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
  return value;
}

}  // namespace palpate::fem::laws
