// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "components/view/frames/page_surface.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/observation_row.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::view {

/// Where a force would be felt: the inward normal of a patch of the surface.
struct ProbedPlace {
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;  ///< of the patch over which the force is spread
};

/// Scalars of the body that are measured, each with independent noise.
struct MeasuredRows {
  std::vector<robot::ObservationRow> rows;
  std::vector<double> sigma_m;  ///< [rows] > 0
};

/// What a robot file adds to what topics say of a robot: its cables, its stiffness, and how far
/// the skin gives way.
class KnownRobot {
 public:
  explicit KnownRobot(robot::RobotBody body);

  robot::RobotModel& model() { return model_; }
  const robot::RobotBody& body() const { return model_.body(); }
  Eigen::Index NodeCount() const { return body().mesh.nodes_m.cols(); }

  /// [3 x points] of each cable by name, from the actuator to its end, of a body with its nodes at
  /// `x_m` [3n]; m, robot frame.
  std::map<std::string, Eigen::Matrix3Xf> CablePaths(const Eigen::VectorXd& x_m) const;

  /// [3 x nodes] undeformed nodes of the surface that do not move in any direction; m, robot frame.
  Eigen::Matrix3Xf FixedSurfaceNodes_m() const;

  /// Young's modulus of the part of that name ("body", or a region); others are passed over.
  /// Returns whether it has changed.
  bool SetYoungsModulus(const std::string& part, double youngs_modulus_Pa);
  /// [nodes of the surface] Young's modulus about each node, the mean over its cells, Pa. Empty
  /// where the surface is of another mesh.
  std::vector<float> Stiffness_Pa(const PageSurface& surface) const;

  /// [3 x names] the markers of these names on the body with its nodes at `x_m` [3n]; NaN: it has
  /// no such marker. m, robot frame.
  Eigen::Matrix3Xd MarkersAt(const std::vector<std::string>& names,
                             const Eigen::VectorXd& x_m) const;

  /// The point of the surface nearest to `position_m`, with the nodes at `x_m` [3n]: where a force
  /// acts that was located on the deformed body.
  fem::InterpolationWeights PlaceNear(const Eigen::Vector3d& position_m,
                                      const Eigen::VectorXd& x_m) const;

  /// Smallest force F, along the inward normal, that stands out of the noise of the measured rows
  /// with a false-alarm probability of `significance`:
  ///   F = z(1 - significance) / sqrt(sum_i (w_i / sigma_i)^2),
  /// w_i: motion of row i per newton, m/N, of the body as it is at `x_m` [3n] under cables of
  /// tensions `tension_N` [cables] (taut ones are held; NaN: not known, counts as taut). Noise
  /// alone counts: unknown other forces and errors of the model make it larger. Failures: no rows,
  /// a shape at which the model has no stable stiffness, a place that moves no row.
  Status SmallestForce(const ProbedPlace& place, const Eigen::VectorXd& x_m,
                       const Eigen::VectorXd& tension_N, const MeasuredRows& measured,
                       double significance, double* force_N);

 private:
  robot::RobotModel model_;
};

}  // namespace palpate::view
