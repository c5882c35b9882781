// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>

#include "libs/fem/shape_functions.hpp"
#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

using Weight = SensitivityCase;

TEST_P(Weight, MassFactor) {
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    robot.body.node_mass_kg *= 1.0 + by;
    return robot;
  };
  ExpectDerivative(robot_, MassFactor(), changed, 1e-3);
}

TEST_P(Weight, DensityOfARegion) {
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    Eigen::VectorXd density_kg_m3 = Eigen::VectorXd::Constant(robot.body.mesh.CellCount(), 500.0);
    for (Eigen::Index cell = 0; cell < density_kg_m3.size(); ++cell) {
      if (robot.body.material_of_cell[static_cast<size_t>(cell)] == 1) {
        density_kg_m3[cell] *= 1.0 + by;
      }
    }
    robot.body.node_mass_kg = fem::ConsistentNodalMass_kg(robot.body.mesh, density_kg_m3);
    return robot;
  };
  ExpectDerivative(robot_, RegionMassFactor(1), changed, 1e-3);
}

TEST_P(Weight, GravityAlongADirection) {
  const Eigen::Vector3d direction(0.6, 0.0, -0.8);
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    robot.body.gravity_m_s2 += by * direction;
    return robot;
  };
  ExpectDerivative(robot_, GravityChange(direction), changed, 1e-2);
}

TEST_P(Weight, GravityTurned) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    robot.body.gravity_m_s2 = Eigen::AngleAxisd(by, axis) * robot.body.gravity_m_s2;
    return robot;
  };
  ExpectDerivative(robot_, GravityTurn(axis), changed, 1e-3);
}

TEST_P(Weight, ExternalForceOnAPatch) {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, 1.0, 0.7).normalized();
  const fem::InterpolationWeights patch =
      Solve(robot_).model->Patch({0.1, 0.01, 0.01}, 0.006).weights;
  ASSERT_GT(patch.nodes.size(), 4U);
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    robot.loads.push_back({patch, by * direction});
    return robot;
  };
  ExpectDerivative(robot_, ExternalForce(patch, direction), changed, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, Weight, AllCases());

}  // namespace
}  // namespace palpate::robot
