// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "components/virtual_robot/bench_body.hpp"
#include "components/virtual_robot/effects.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/fem/node_matrix.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot {

/// A dead load where it acts.
struct PointLoad {
  std::string name;
  fem::InterpolationWeights weights;
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
};

/// The dead loads: the body's own weight, weights that hang on it, and what the effects
/// gravity_direction, payload and permanent_force add. Tilting the base by (a, b) turns the robot
/// frame in the world by R = Ry(b) Rx(a); what is fixed in the world turns back in it.
class ExternalLoads {
 public:
  /// Adds the inertia of payloads to `mass`, the mass matrix of the body. Throws InputError.
  ExternalLoads(const BenchBody& body, const Effects& effects, fem::NodeMatrix* mass);

  Eigen::Vector3d Gravity_m_s2(const Eigen::Vector2d& base_tilt_deg) const;
  /// Payloads, permanent forces and hung weights (named weight_0, ...), without the body's weight.
  std::vector<PointLoad> PointLoads(const std::vector<scenario::HungWeight>& weights,
                                    const Eigen::Vector2d& base_tilt_deg);
  /// All of it [3n]; `points` are PointLoads of the same tilt.
  Eigen::VectorXd Nodal_N(const std::vector<PointLoad>& points,
                          const Eigen::Vector2d& base_tilt_deg) const;

 private:
  struct Permanent {
    fem::BodyPoint point;
    Eigen::Vector3d world_N;
  };
  struct Payload {
    fem::BodyPoint point;
    double mass_kg;
  };

  const fem::SurfacePatch& Patch(const scenario::HungWeight& weight);

  fem::PointLocator locator_;  ///< on the body as drawn
  Eigen::Vector3d gravity_m_s2_;
  Eigen::Matrix3d R_misaligned_;
  Eigen::VectorXd node_mass_kg_;  ///< [n] of the body alone
  std::vector<Permanent> permanent_;
  std::vector<Payload> payloads_;
  std::map<std::array<double, 4>, fem::SurfacePatch> patches_;  ///< by position and radius
};

}  // namespace palpate::virtual_robot
