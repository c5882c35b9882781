// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/body_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "libs/core/error.hpp"
#include "libs/robot/calibrated_geometry.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kTolerance = 1e-5;  ///< responses are solved in single precision

/// `size`: over that of the robot file.
BodyScale ScaleOfRod(double youngs_modulus_Pa, double size) {
  robot::RobotDescription rod = test_support::LinearRobot("rod");
  rod.material.youngs_modulus_Pa = youngs_modulus_Pa;
  robot::RobotBody body = robot::BuildRobotBody(rod);
  if (size != 1.0) robot::ScaleBody(size, &body);
  return ScaleOf(body);
}

TEST(BodyScale, GrowsWithTheModulusAndTheSquareOfTheSize) {
  constexpr double kModulus_Pa = 250e3;
  const BodyScale rod = ScaleOfRod(kModulus_Pa, 1.0);
  EXPECT_NEAR(rod.length_m, std::hypot(0.1, std::hypot(0.03, 0.03)), 1e-9);
  const BodyScale stiff = ScaleOfRod(3.0 * kModulus_Pa, 1.0);
  EXPECT_EQ(stiff.length_m, rod.length_m);
  EXPECT_NEAR(stiff.force_N, 3.0 * rod.force_N, kTolerance * stiff.force_N);
  const BodyScale large = ScaleOfRod(kModulus_Pa, 2.0);
  EXPECT_NEAR(large.length_m, 2.0 * rod.length_m, 1e-12);
  EXPECT_NEAR(large.force_N, 4.0 * rod.force_N, kTolerance * large.force_N);
}

TEST(BodyScale, RefusesABodyOfWhichOnlyTheClampIsSeen) {
  robot::RobotDescription rod = test_support::LinearRobot("rod");
  rod.feature_points_m = Eigen::Vector3d(-0.1, 0.015, 0.015);
  EXPECT_THROW(ScaleOf(robot::BuildRobotBody(rod)), InputError);
}

}  // namespace
}  // namespace palpate::force_estimation
