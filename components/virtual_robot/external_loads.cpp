// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/external_loads.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace palpate::virtual_robot {

namespace {

/// Ry(b) Rx(a)
Eigen::Matrix3d Tilt(const Eigen::Vector2d& angles_deg) {
  const Eigen::Vector2d angles_rad = angles_deg * (std::numbers::pi / 180.0);
  return (Eigen::AngleAxisd(angles_rad.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles_rad.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

void AddPointMass(const fem::InterpolationWeights& weights, double mass_kg, fem::NodeMatrix* mass) {
  for (size_t a = 0; a < weights.nodes.size(); ++a) {
    for (size_t b = 0; b <= a; ++b) {
      mass->Add(weights.nodes[a], weights.nodes[b],
                mass_kg * weights.weights[a] * weights.weights[b]);
    }
  }
}

}  // namespace

ExternalLoads::ExternalLoads(const BenchBody& body, const Effects& effects, fem::NodeMatrix* mass)
    : locator_(body.nominal),
      gravity_m_s2_(body.gravity_m_s2),
      R_misaligned_(Eigen::Matrix3d::Identity()) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(3 * body.mesh.NodeCount());
  mass->AddProduct(Eigen::VectorXd::Ones(sums.size()), 1.0, sums);
  node_mass_kg_ = sums.reshaped(3, body.mesh.NodeCount()).row(0).transpose();
  for (const auto* effect : OfKind(effects, "gravity_direction")) {
    R_misaligned_ =
        R_misaligned_ * Tilt({Value(*effect, "theta_x_deg"), Value(*effect, "theta_y_deg")});
  }
  for (const auto* effect : OfKind(effects, "payload")) {
    const double mass_kg = NonNegativeValue(*effect, "mass_kg");
    payloads_.push_back({locator_.Embed(Values(*effect, "x_m", "y_m", "z_m")), mass_kg});
    AddPointMass(payloads_.back().point.weights, mass_kg, mass);
  }
  for (const auto* effect : OfKind(effects, "permanent_force")) {
    permanent_.push_back({locator_.Embed(Values(*effect, "x_m", "y_m", "z_m")),
                          Values(*effect, "fx_N", "fy_N", "fz_N")});
  }
}

Eigen::Vector3d ExternalLoads::Gravity_m_s2(const Eigen::Vector2d& base_tilt_deg) const {
  return (Tilt(base_tilt_deg) * R_misaligned_).transpose() * gravity_m_s2_;
}

const fem::SurfacePatch& ExternalLoads::Patch(const scenario::HungWeight& weight) {
  const Eigen::Vector3d& at_m = weight.position_m;
  const std::array<double, 4> key{at_m.x(), at_m.y(), at_m.z(), weight.patch_radius_m};
  const auto known = patches_.find(key);
  if (known != patches_.end()) return known->second;
  return patches_.emplace(key, fem::MakeSurfacePatch(locator_, at_m, weight.patch_radius_m))
      .first->second;
}

std::vector<PointLoad> ExternalLoads::PointLoads(const std::vector<scenario::HungWeight>& weights,
                                                 const Eigen::Vector2d& base_tilt_deg) {
  const Eigen::Vector3d gravity_m_s2 = Gravity_m_s2(base_tilt_deg);
  std::vector<PointLoad> loads;
  for (size_t k = 0; k < weights.size(); ++k) {
    const fem::SurfacePatch& patch = Patch(weights[k]);
    loads.push_back({"weight_" + std::to_string(k), patch.weights, patch.centre_m,
                     weights[k].mass_kg * gravity_m_s2});
  }
  for (const Payload& payload : payloads_) {
    loads.push_back(
        {"payload", payload.point.weights, payload.point.rest_m, payload.mass_kg * gravity_m_s2});
  }
  for (const Permanent& permanent : permanent_) {
    loads.push_back({"permanent_force", permanent.point.weights, permanent.point.rest_m,
                     Tilt(base_tilt_deg).transpose() * permanent.world_N});
  }
  return loads;
}

Eigen::VectorXd ExternalLoads::Nodal_N(const std::vector<PointLoad>& points,
                                       const Eigen::Vector2d& base_tilt_deg) const {
  const Eigen::Vector3d gravity_m_s2 = Gravity_m_s2(base_tilt_deg);
  Eigen::VectorXd nodal_N(3 * node_mass_kg_.size());
  for (Eigen::Index node = 0; node < node_mass_kg_.size(); ++node) {
    nodal_N.segment<3>(3 * node) = node_mass_kg_[node] * gravity_m_s2;
  }
  for (const PointLoad& load : points) {
    for (size_t k = 0; k < load.weights.nodes.size(); ++k) {
      nodal_N.segment<3>(3 * load.weights.nodes[k]) += load.weights.weights[k] * load.force_N;
    }
  }
  return nodal_N;
}

}  // namespace palpate::virtual_robot
