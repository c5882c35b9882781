// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libs/robot/robot_model.hpp"
#include "tests/components/virtual_robot/bench_setup.hpp"
#include "tests/support/robots.hpp"

namespace palpate::virtual_robot::test {
namespace {

/// Mean frequency of a motion about its mean, from the upward crossings.
double Frequency_hz(const std::vector<double>& z_m, double h_s) {
  double mean_m = 0.0;
  for (const double z : z_m) mean_m += z / static_cast<double>(z_m.size());
  std::vector<double> crossing_s;
  for (size_t k = 1; k < z_m.size(); ++k) {
    if (z_m[k - 1] < mean_m && z_m[k] >= mean_m) {
      const double part = (mean_m - z_m[k - 1]) / (z_m[k] - z_m[k - 1]);
      crossing_s.push_back((static_cast<double>(k) - 1.0 + part) * h_s);
    }
  }
  if (crossing_s.size() < 2) return 0.0;
  return static_cast<double>(crossing_s.size() - 1) / (crossing_s.back() - crossing_s.front());
}

/// The measured beam: what `palpate calibrate` finds for its own weight (280 kPa), and a tenth more
/// for the stiffness at some Hz.
robot::RobotDescription MeasuredBeam() {
  robot::RobotDescription robot = test_support::ReadRobot("beam");
  robot.material.youngs_modulus_Pa = 1.1 * 280e3;
  return robot;
}

constexpr double kRelease_s = 1e-6;

/// Bent by a weight at its tip, which is taken away.
void Release(double mass_kg, VirtualRobot* robot) {
  Inputs bent = NoInputs(0);
  bent.weights = {Weight({0.0, 0.015, 0.03}, mass_kg, 0.004)};
  ASSERT_TRUE(robot->Start(0.0, bent).ok());
  ASSERT_TRUE(robot->Advance(kRelease_s, NoInputs(0)).ok());
}

TEST(Dynamics, ReleasedBeamKeepsItsEnergyForASecond) {
  constexpr double kStep_s = 1.0 / 120.0;
  VirtualRobot robot(MeasuredBeam(), DynamicScenario(kStep_s, 0.0, 0.0), {}, 1);
  Release(0.052, &robot);
  const double energy_J = robot.TotalEnergy_J();
  double kinetic_J = 0.0;
  double drift_J = 0.0;
  for (int k = 1; k <= 120; ++k) {
    ASSERT_TRUE(robot.Advance(kRelease_s + k * kStep_s, NoInputs(0)).ok()) << k;
    drift_J = std::max(drift_J, std::abs(robot.TotalEnergy_J() - energy_J));
    kinetic_J = std::max(kinetic_J, robot.KineticEnergy_J());
  }
  EXPECT_GT(kinetic_J, 1e-3);
  EXPECT_LE(drift_J, 1e-4 * kinetic_J);
}

TEST(Dynamics, BeamSwingsAtTheFrequencyOfTheMeasuredOne) {
  constexpr double kStep_s = 1.0 / 240.0;
  VirtualRobot robot(MeasuredBeam(), DynamicScenario(kStep_s, 0.2, 1e-4), {}, 1);
  Release(0.005, &robot);
  std::vector<double> z_m;
  for (int k = 1; k <= 180; ++k) {
    ASSERT_TRUE(robot.Advance(kRelease_s + k * kStep_s, NoInputs(0)).ok()) << k;
    z_m.push_back(robot.MarkerPositions_m()(2, 0));
  }
  EXPECT_NEAR(Frequency_hz(z_m, kStep_s), 7.7, 0.05 * 7.7);
}

TEST(Dynamics, SlenderCantileverSwingsAtTheFrequencyOfBeamTheory) {
  const Eigen::Vector3d size_m(0.2, 0.01, 0.01);
  constexpr double kStep_s = 1.0 / 120.0;
  robot::RobotDescription box = BoxRobot({12, 1, 1}, size_m);
  box.gravity_m_s2 = {0.0, 0.0, -0.01};
  VirtualRobot swung(box, DynamicScenario(kStep_s, 0.0, 0.0), {}, 1);
  Inputs bent = NoInputs(0);
  bent.weights = {Weight({0.2, 0.005, 0.005}, 5e-3)};
  ASSERT_TRUE(swung.Start(0.0, bent).ok());
  std::vector<double> z_m;
  const int tip = [&] {
    Eigen::Index node = 0;
    (swung.mesh().nodes_m.colwise() - size_m).colwise().squaredNorm().minCoeff(&node);
    return static_cast<int>(node);
  }();
  for (int k = 1; k <= 480; ++k) {
    ASSERT_TRUE(swung.Advance(k * kStep_s, NoInputs(0)).ok());
    z_m.push_back(swung.positions_m()[3 * tip + 2]);
  }
  const double bending_m2_s = std::sqrt(1e5 * size_m.z() * size_m.z() / 12.0 / 1000.0);
  const double theory_hz = 0.5596 * bending_m2_s / (size_m.x() * size_m.x());
  EXPECT_NEAR(Frequency_hz(z_m, kStep_s), theory_hz, 0.02 * theory_hz);
}

TEST(Dynamics, DampedBeamComesToRestInTheStaticSolutionOfItsMesh) {
  const robot::RobotDescription beam = MeasuredBeam();
  VirtualRobot robot(beam, DynamicScenario(1.0 / 60.0, 20.0, 5e-3), {}, 1);
  Release(0.052, &robot);
  ASSERT_TRUE(robot.Advance(1.5, NoInputs(0)).ok());

  robot::RobotModel model(robot::BuildRobotBody(beam));
  fem::StaticState state = model.RestState();
  ASSERT_TRUE(model.Solve({}, {}, &state).status.ok());
  ASSERT_EQ(state.x_m.size(), robot.positions_m().size());
  EXPECT_LE((robot.positions_m() - state.x_m).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LE(robot.KineticEnergy_J(), 1e-12);
}

TEST(Dynamics, DampingTakesEnergyAway) {
  robot::RobotDescription heavy = BoxRobot({6, 2, 2}, {0.1, 0.02, 0.02});
  heavy.gravity_m_s2 = {0.0, 0.0, -9.81};
  VirtualRobot swung(heavy, DynamicScenario(1.0 / 60.0, 1.0, 1e-3), {}, 1);
  Inputs bent = NoInputs(0);
  bent.weights = {Weight({0.1, 0.01, 0.02}, 0.01)};
  ASSERT_TRUE(swung.Start(0.0, bent).ok());
  ASSERT_TRUE(swung.Advance(1e-6, NoInputs(0)).ok());
  const double energy_J = swung.TotalEnergy_J();
  for (int k = 1; k <= 60; ++k) {
    ASSERT_TRUE(swung.Advance(k / 60.0, NoInputs(0)).ok());
    EXPECT_LE(swung.TotalEnergy_J(), energy_J) << k;
  }
  EXPECT_LT(swung.TotalEnergy_J(), energy_J - 1e-5);
}

}  // namespace
}  // namespace palpate::virtual_robot::test
