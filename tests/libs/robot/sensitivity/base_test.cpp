// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>

#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

class BaseOfRobot : public SensitivityCase {
 protected:
  Eigen::Vector3d Turned(const Eigen::Vector3d& point_m, double angle_rad) const {
    return Eigen::AngleAxisd(angle_rad, axis_) * (point_m - pivot_m_) + pivot_m_;
  }

  /// The base displaced by `motion` (of a point at rest), pull points along or not.
  RobotCase Moved(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& moved_m,
                  BaseRiders riders) const {
    RobotCase robot = robot_;
    for (Eigen::Index node = 0; node < robot.body.mesh.nodes_m.cols(); ++node) {
      const Eigen::Vector3d rest_m = robot.body.mesh.nodes_m.col(node);
      robot.held_motion_m.segment<3>(3 * node) = moved_m(rest_m) - rest_m;
    }
    if (riders == BaseRiders::kHeldNodesAndPullPoints) {
      for (size_t c = 0; c < robot.cables.size(); ++c) {
        Eigen::Vector3d& pull_m = robot.body.cables[c].pull_point_m;
        const double before_m = RestLength_m(robot.body, c);
        pull_m = moved_m(pull_m);
        // The commands count from where they did.
        if (robot.cables[c].kind == ActuatorCommand::Kind::kDisplacement) {
          robot.cables[c].value += RestLength_m(robot.body, c) - before_m;
        }
      }
    }
    return robot;
  }

  const Eigen::Vector3d axis_ = Eigen::Vector3d(0.3, 1.0, -0.6).normalized();
  const Eigen::Vector3d pivot_m_{-0.004, 0.008, 0.012};
};

TEST_P(BaseOfRobot, Rotation) {
  for (const BaseRiders riders : {BaseRiders::kHeldNodes, BaseRiders::kHeldNodesAndPullPoints}) {
    const auto changed = [&](double by) {
      return Moved([&](const Eigen::Vector3d& point_m) { return Turned(point_m, by); }, riders);
    };
    ExpectDerivative(robot_, BaseRotation(axis_, pivot_m_, riders), changed, 5e-4);
  }
}

TEST_P(BaseOfRobot, Translation) {
  for (const BaseRiders riders : {BaseRiders::kHeldNodes, BaseRiders::kHeldNodesAndPullPoints}) {
    const auto changed = [&](double by) {
      return Moved(
          [&](const Eigen::Vector3d& point_m) { return Eigen::Vector3d(point_m + by * axis_); },
          riders);
    };
    ExpectDerivative(robot_, BaseTranslation(axis_, riders), changed, 2e-5);
  }
}

/// Re-solved with an elastic base by fixed-point steps. What the body does to its base is, by the
/// balance of the whole body, what everything else does to the body.
TEST_P(BaseOfRobot, Compliance) {
  Eigen::Matrix<double, 6, 6> compliance = Eigen::Matrix<double, 6, 6>::Zero();
  compliance.diagonal() << 1.0, 2.0, 0.5, 2e-4, 1e-4, 3e-4;
  compliance(0, 4) = compliance(4, 0) = 3e-3;
  for (const BaseRiders riders : {BaseRiders::kHeldNodes, BaseRiders::kHeldNodesAndPullPoints}) {
    const Balance rigid = Solve(robot_);
    const auto changed = [&](double factor) {
      RobotCase robot = robot_;
      for (int step = 0; step < 4; ++step) {
        const Balance balance = Solve(robot, &rigid.state);
        Eigen::VectorXd force_N = balance.model->Loads(robot.cables, robot.loads).external_force_N;
        Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
        const auto add = [&](const Eigen::Vector3d& at_m, const Eigen::Vector3d& by_N) {
          wrench.head<3>() += (at_m - pivot_m_).cross(by_N);
          wrench.tail<3>() += by_N;
        };
        for (int c = 0; c < 3; ++c) {
          const double tension_N = balance.Tensions_N()[c];
          balance.model->cable(c).AddGradient(balance.state.x_m, -tension_N, force_N);
          if (riders == BaseRiders::kHeldNodes) continue;
          const Eigen::Matrix3Xd path_m = balance.model->cable(c).Path_m(balance.state.x_m);
          add(path_m.col(0), tension_N * (path_m.col(1) - path_m.col(0)).normalized());
        }
        for (Eigen::Index node = 0; node < force_N.size() / 3; ++node) {
          add(balance.state.x_m.segment<3>(3 * node), force_N.segment<3>(3 * node));
        }
        const Eigen::Matrix<double, 6, 1> motion = factor * compliance * wrench;
        robot = Moved(
            [&](const Eigen::Vector3d& at_m) {
              return Eigen::Vector3d(at_m + motion.head<3>().cross(at_m - pivot_m_) +
                                     motion.tail<3>());
            },
            riders);
      }
      return robot;
    };
    ExpectDerivative(robot_, BaseCompliance(compliance, pivot_m_, riders), changed, 5e-3);
  }
}

/// Base, drives and gravity turned together turn everything, and no cable notices.
TEST_P(BaseOfRobot, TurningEverythingTurnsTheBody) {
  robot_.loads.clear();
  Balance balance = Solve(robot_);
  const Derivative base = Differentiate(
      balance, robot_, BaseRotation(axis_, pivot_m_, BaseRiders::kHeldNodesAndPullPoints));
  const Derivative gravity = Differentiate(balance, robot_, GravityTurn(axis_));
  const Eigen::VectorXd points_m = balance.Points_m();
  for (Eigen::Index k = 0; k < points_m.size(); k += 3) {
    const Eigen::Vector3d expected = axis_.cross(points_m.segment<3>(k) - pivot_m_);
    const Eigen::Vector3d found = (base.points_m + gravity.points_m).segment<3>(k);
    EXPECT_LE((found - expected).norm(), 1e-9 * points_m.norm());
  }
  EXPECT_LE((base.tensions_N + gravity.tensions_N).norm(), 1e-9 * (1.0 + base.tensions_N.norm()));
  EXPECT_LE((base.lengths_m + gravity.lengths_m).norm(), 1e-11);
  EXPECT_GT(base.points_m.norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, BaseOfRobot, AllCases());

}  // namespace
}  // namespace palpate::robot
