// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

using Material = SensitivityCase;

TEST_P(Material, YoungsModulusOfABodyAndARegion) {
  for (const int material : {0, 1}) {
    const auto changed = [&](double by) {
      RobotCase robot = robot_;
      robot.body.materials[static_cast<size_t>(material)].youngs_modulus_Pa += by;
      return robot;
    };
    ExpectDerivative(robot_, YoungsModulus(material), changed, 100.0);
  }
}

TEST_P(Material, PoissonsRatio) {
  for (const int material : {0, 1}) {
    const auto changed = [&](double by) {
      RobotCase robot = robot_;
      robot.body.materials[static_cast<size_t>(material)].poissons_ratio += by;
      return robot;
    };
    ExpectDerivative(robot_, PoissonsRatio(material), changed, 2e-4);
  }
}

/// Near incompressibility, where the Lame constants change fast.
TEST_P(Material, PoissonsRatioNearOneHalf) {
  for (fem::Material& material : robot_.body.materials) material.poissons_ratio = 0.495;
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    robot.body.materials[0].poissons_ratio += by;
    return robot;
  };
  ExpectDerivative(robot_, PoissonsRatio(0), changed, 2e-5);
}

TEST_P(Material, OfACorotationalBodyAndOneOfSaintVenantAndKirchhoff) {
  for (fem::Material& material : robot_.body.materials) {
    material.volumetric = fem::Volumetric::kPointwise;
  }
  robot_.body.materials[0].model = fem::MaterialModel::kCorotational;
  robot_.body.materials[1].model = fem::MaterialModel::kStVenantKirchhoff;
  for (const int material : {0, 1}) {
    const auto changed = [&](double by) {
      RobotCase robot = robot_;
      robot.body.materials[static_cast<size_t>(material)].poissons_ratio += by;
      return robot;
    };
    ExpectDerivative(robot_, PoissonsRatio(material), changed, 2e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, Material, AllCases());

}  // namespace
}  // namespace palpate::robot
