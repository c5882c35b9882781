// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <functional>

#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

/// Weight of nodal masses [n] per unit of the parameter, kg.
void AddWeight(const Eigen::VectorXd& mass_kg, const Eigen::Vector3d& gravity_m_s2,
               ParameterColumn* column) {
  Eigen::VectorXd& force_N = column->distributed_force_N();
  for (Eigen::Index node = 0; node < mass_kg.size(); ++node) {
    force_N.segment<3>(3 * node) += mass_kg[node] * gravity_m_s2;
  }
}

class Mass final : public Parameter {
 public:
  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    AddWeight(at.model().body().node_mass_kg, at.model().gravity_m_s2(), column);
  }
};

class RegionMass final : public Parameter {
 public:
  explicit RegionMass(int material) : material_(material) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    const double total_kg = at.model().body().node_mass_kg.sum();
    const double volume_m3 = at.nodal_volume_m3().sum();
    AddWeight(total_kg / volume_m3 * at.elements().NodalVolume_m3(material_),
              at.model().gravity_m_s2(), column);
  }

 private:
  int material_;
};

/// Change of gravity at the model's masses.
class Gravity final : public Parameter {
 public:
  using Change = std::function<Eigen::Vector3d(const Eigen::Vector3d& gravity_m_s2)>;
  explicit Gravity(Change change) : change_(std::move(change)) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    AddWeight(at.model().body().node_mass_kg, change_(at.model().gravity_m_s2()), column);
  }

 private:
  Change change_;
};

}  // namespace

ParameterPtr MassFactor() { return std::make_unique<Mass>(); }

ParameterPtr RegionMassFactor(int material) { return std::make_unique<RegionMass>(material); }

ParameterPtr GravityChange(const Eigen::Vector3d& change_m_s2) {
  return std::make_unique<Gravity>([change_m_s2](const Eigen::Vector3d&) { return change_m_s2; });
}

ParameterPtr GravityTurn(const Eigen::Vector3d& axis) {
  return std::make_unique<Gravity>(
      [axis](const Eigen::Vector3d& gravity_m_s2) { return axis.cross(gravity_m_s2).eval(); });
}

}  // namespace palpate::robot
