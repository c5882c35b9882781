// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <vector>

#include "libs/fem/scalar_constraint.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::diagnosis {

/// Where a body can meet an obstacle, and how hard obstacles are there: a node that is pressed with
/// the largest modulus on its share of the surface goes some micrometres deep.
struct ObstacleSurface {
  std::vector<int> nodes;      ///< of the faces that are not held altogether
  double stiffness_N_m = 0.0;  ///< of an obstacle against each of them

  double Force_N(double depth_m) const { return stiffness_N_m * std::max(0.0, depth_m); }
};

ObstacleSurface SurfaceForObstacles(const robot::RobotBody& body);

/// A half-space at rest in the robot frame that a body slides along but does not enter.
struct Obstacle {
  std::shared_ptr<const ObstacleSurface> surface;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, towards the body
  double offset_m = 0.0;                              ///< normal' x of its points

  double Depth_m(int node, const Eigen::VectorXd& x_m) const {
    return offset_m - normal.dot(x_m.segment<3>(3 * node));
  }
};

/// The least normal' x of a body with its nodes at `x_m` [3n], m: the offset of an obstacle that
/// would just touch it.
double NearestAlong(const ObstacleSurface& surface, const Eigen::Vector3d& normal,
                    const Eigen::VectorXd& x_m);

/// How far the body is from the obstacle, m; negative where it presses on it.
inline double ObstacleClearance_m(const Obstacle& obstacle, const Eigen::VectorXd& x_m) {
  return NearestAlong(*obstacle.surface, obstacle.normal, x_m) - obstacle.offset_m;
}

/// [3n] of an obstacle that presses with `force_N` on the nodes of its surface.
Eigen::VectorXd NodalForces_N(const Obstacle& obstacle, const Eigen::VectorXd& force_N,
                              Eigen::Index size);

/// What the obstacle presses with where its normal and its offset change by so much per p; it
/// presses with `force_N` [nodes of its surface].
robot::ParameterPtr ObstacleMotion(const Obstacle& obstacle, const Eigen::VectorXd& force_N,
                                   const Eigen::Vector3d& normal_change, double offset_change_m);

/// The obstacle in a body's tangent: its energy is what a constraint with a given multiplier adds.
/// Where the body comes to rest at it: ObstacleBalance.
class ObstacleContact final : public fem::ScalarConstraint {
 public:
  /// The multiplier that an obstacle has which is there. Far below any force, since what a balance
  /// may leave follows the largest multiplier: an obstacle that nothing touches changes nothing.
  static constexpr double kThere_N = 1e-9;

  explicit ObstacleContact(Obstacle obstacle) : obstacle_(std::move(obstacle)) {}

  const Obstacle& obstacle() const { return obstacle_; }

  double Value(const Eigen::VectorXd& x_m) const override;
  void AddGradient(const Eigen::VectorXd& x_m, double factor,
                   Eigen::VectorXd& nodal) const override;
  fem::NodePairs CoupledPairs() const override { return {}; }
  void BindTo(const fem::StiffnessMatrix& stiffness) override;
  void AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                    fem::StiffnessMatrix& stiffness) const override;

 private:
  Obstacle obstacle_;
  std::vector<fem::BlockSlot> slots_;  ///< [nodes of the surface]
};

}  // namespace palpate::diagnosis
