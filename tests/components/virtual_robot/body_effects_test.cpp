// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>

#include "tests/components/virtual_robot/bench_setup.hpp"

namespace palpate::virtual_robot::test {
namespace {

const Eigen::Vector3d kSize_m(0.08, 0.02, 0.02);
const Eigen::Vector3d kTip_m(0.08, 0.01, 0.01);

/// A beam that sags a little, with a marker in the middle of its end.
robot::RobotDescription Beam() {
  robot::RobotDescription beam = BoxRobot({4, 1, 1}, kSize_m);
  beam.gravity_m_s2 = {0.0, 0.0, -9.81};
  beam.mass.density_kg_m3 = 300.0;
  beam.markers.push_back({"tip", kTip_m, {}});
  beam.regions.push_back(
      {"root", {.lower_m = {-1.0, -1.0, -1.0}, .upper_m = {0.04, 1.0, 1.0}}, {}, {}});
  return beam;
}

class BodyEffects : public ::testing::Test {
 protected:
  std::unique_ptr<VirtualRobot> Hung(const Effects& effects,
                                     const Inputs& inputs = NoInputs(0)) const {
    auto robot = std::make_unique<VirtualRobot>(beam_, PlainScenario(), effects, 3);
    const Status status = robot->Start(0.0, inputs);
    EXPECT_TRUE(status.ok()) << status.message();
    return robot;
  }
  Eigen::Vector3d Moved_m(const Effects& effects, const Inputs& inputs = NoInputs(0)) const {
    return Hung(effects, inputs)->MarkerPositions_m().col(0) - kTip_m;
  }
  double Sag_m(const Effects& effects) const { return -Moved_m(effects).z(); }

  robot::RobotDescription beam_ = Beam();
};

TEST_F(BodyEffects, OfNoSizeChangeNothing) {
  const Eigen::VectorXd healthy_m = Hung({})->positions_m();
  const Effects none = {
      Effect("youngs_modulus", {"body"}, {{"factor", 1.0}}),
      Effect("regional_stiffness", {"region:root"}, {{"factor", 1.0}}),
      Effect("poissons_ratio", {"body"}, {{"nu", 0.3}}),
      Effect("density", {"body"}, {{"factor", 1.0}}),
      Effect("viscoelastic_creep", {"body"}, {{"g", 0.0}, {"tau_s", 1.0}}),
      Effect("plastic_set", {"body"}, {{"tip_m", 0.0}}),
      Effect("geometry_scale", {"body"}, {{"factor", 1.0}}),
      Effect("temperature", {"body"}, {{"relative_E_change_at_end", 0.0}}),
      Effect("rest_twist", {"body"}, {{"rate_rad_m", 0.0}}),
      Effect("base_compliance", {"base"}, {{"compliance_rad_Nm", 0.0}}),
      Effect("gravity_direction", {"base"}, {{"theta_x_deg", 0.0}, {"theta_y_deg", 0.0}}),
      Effect("payload", {"body"}, {{"mass_kg", 0.0}, {"x_m", 0.05}, {"y_m", 0.01}, {"z_m", 0.01}}),
      Effect("permanent_force", {"body"},
             {{"fx_N", 0.0},
              {"fy_N", 0.0},
              {"fz_N", 0.0},
              {"x_m", 0.05},
              {"y_m", 0.01},
              {"z_m", 0.01}}),
      Effect("hidden_obstacle", {"body"}, {{"gap_m", 0.1}, {"nx", 0.0}, {"ny", 0.0}, {"nz", 1.0}}),
      Effect("marker_misplacement", {"marker:tip"}, {{"d_m", 0.0}}),
      Effect("camera_moved", {"camera"}, {{"translation_m", 0.1}})};
  for (const scenario::ActiveEffect& effect : none) {
    EXPECT_LE((Hung({effect})->positions_m() - healthy_m).cwiseAbs().maxCoeff(), 1e-12)
        << effect.id;
  }
}

TEST_F(BodyEffects, SagGrowsWithWeightAndFallsWithStiffness) {
  const double healthy_m = Sag_m({});
  EXPECT_GT(healthy_m, 5e-4);
  EXPECT_NEAR(Sag_m({Effect("youngs_modulus", {"body"}, {{"factor", 2.0}})}) / healthy_m, 0.5,
              0.01);
  EXPECT_NEAR(Sag_m({Effect("density", {"body"}, {{"factor", 1.2}})}) / healthy_m, 1.2, 0.01);
  const double root_m = Sag_m({Effect("regional_stiffness", {"region:root"}, {{"factor", 2.0}})});
  EXPECT_LT(root_m, 0.62 * healthy_m);  // the clamped half bends most
  EXPECT_GT(root_m, 0.5 * healthy_m);
}

TEST_F(BodyEffects, StiffeningMaterialIsTheSameForSmallStrainsOnly) {
  beam_.gravity_m_s2.z() = -0.1;
  const double soft_m = Sag_m({});
  const Effects stiffening = {Effect("stiffening", {"body"}, {{"C2_over_C1", 2.0}})};
  EXPECT_NEAR(Sag_m(stiffening) / soft_m, 1.0, 1e-3);
  beam_.gravity_m_s2.z() = -60.0;
  const double bent_m = Sag_m({Effect("stiffening", {"body"}, {{"C2_over_C1", 0.0}})});
  EXPECT_LT(Sag_m(stiffening), 0.99 * bent_m);
}

TEST_F(BodyEffects, ScaledBodyKeepsItsClampAndGrows) {
  const auto robot = Hung({Effect("geometry_scale", {"body"}, {{"factor", 1.03}})});
  EXPECT_NEAR(robot->mesh().nodes_m.row(0).maxCoeff(), 1.03 * kSize_m.x(), 1e-12);
  EXPECT_NEAR(robot->mesh().nodes_m.row(1).mean(), 0.01, 1e-9);
}

TEST_F(BodyEffects, TwistedBodyTurnsInProportionToTheDistanceFromTheClamp) {
  constexpr double kRate_rad_m = 2.0;
  const auto robot = Hung({Effect("rest_twist", {"body"}, {{"rate_rad_m", kRate_rad_m}})});
  const Eigen::Matrix3Xd& nodes_m = robot->mesh().nodes_m;
  const auto healthy = Hung({});
  for (int node = 0; node < robot->mesh().NodeCount(); ++node) {
    const Eigen::Vector3d before_m = healthy->mesh().nodes_m.col(node);
    const Eigen::Vector3d middle_m(before_m.x(), 0.01, 0.01);
    const Eigen::AngleAxisd turn(kRate_rad_m * before_m.x(), Eigen::Vector3d::UnitX());
    EXPECT_LE((nodes_m.col(node) - middle_m - turn * (before_m - middle_m)).norm(), 1e-12);
  }
}

TEST_F(BodyEffects, PlasticSetMovesTheTipByItsSizeAndNotTheClamp) {
  const auto robot = Hung({Effect("plastic_set", {"body"}, {{"tip_m", 0.003}})});
  const auto healthy = Hung({});
  const Eigen::Matrix3Xd set_m = robot->mesh().nodes_m - healthy->mesh().nodes_m;
  EXPECT_NEAR(set_m.colwise().norm().maxCoeff(), 0.003, 1e-12);
  for (int node = 0; node < robot->mesh().NodeCount(); ++node) {
    if (healthy->mesh().nodes_m(0, node) < 1e-9) {
      EXPECT_EQ(set_m.col(node).norm(), 0.0);
    }
  }
}

TEST_F(BodyEffects, SoftBaseTurnsByComplianceTimesMoment) {
  constexpr double kCompliance_rad_Nm = 2.0;
  const double moment_Nm = 300.0 * kSize_m.prod() * 9.81 * 0.5 * kSize_m.x();
  const double expected_m = kCompliance_rad_Nm * moment_Nm * kSize_m.x();
  const double more_m =
      Sag_m({Effect("base_compliance", {"base"}, {{"compliance_rad_Nm", kCompliance_rad_Nm}})}) -
      Sag_m({});
  EXPECT_NEAR(more_m / expected_m, 1.0, 0.05);
}

TEST_F(BodyEffects, TiltedBaseTurnsGravityBackInTheRobotFrame) {
  Inputs tilted = NoInputs(0);
  tilted.base_tilt_deg = {90.0, 0.0};  // R' g = Rx(-90) (0, 0, -g) = (0, -g, 0)
  const Eigen::Vector3d by_tilt_m = Moved_m({}, tilted);
  EXPECT_NEAR(by_tilt_m.y(), -Sag_m({}), 1e-5);
  const Eigen::Vector3d by_effect_m = Moved_m(
      {Effect("gravity_direction", {"base"}, {{"theta_x_deg", 90.0}, {"theta_y_deg", 0.0}})});
  EXPECT_LE((by_effect_m - by_tilt_m).norm(), 1e-12);
}

TEST_F(BodyEffects, PayloadIsAsAHungWeightThatStays) {
  Inputs hung = NoInputs(0);
  hung.weights = {Weight(kTip_m, 0.002)};
  const Eigen::Vector3d weight_m = Moved_m({}, hung);
  const auto robot = Hung({Effect(
      "payload", {"body"}, {{"mass_kg", 0.002}, {"x_m", 0.08}, {"y_m", 0.01}, {"z_m", 0.01}})});
  EXPECT_LE((robot->MarkerPositions_m().col(0) - kTip_m - weight_m).norm(), 1e-9);
  ASSERT_EQ(robot->forces().size(), 1U);
  EXPECT_NEAR(robot->forces().front().force_N.z(), -0.002 * 9.81, 1e-12);
}

TEST_F(BodyEffects, PermanentForceStaysInTheWorldWhereTheBaseIsTilted) {
  const Effects force = {Effect("permanent_force", {"body"},
                                {{"fx_N", 0.0},
                                 {"fy_N", 0.0},
                                 {"fz_N", -0.01},
                                 {"x_m", 0.08},
                                 {"y_m", 0.01},
                                 {"z_m", 0.01}})};
  Inputs tilted = NoInputs(0);
  tilted.base_tilt_deg = {90.0, 0.0};
  const auto robot = Hung(force, tilted);
  ASSERT_EQ(robot->forces().size(), 1U);
  EXPECT_EQ(robot->forces().front().name, "permanent_force");
  EXPECT_LE((robot->forces().front().force_N - Eigen::Vector3d(0.0, -0.01, 0.0)).norm(), 1e-15);
  EXPECT_LT(Moved_m(force, tilted).y(), Moved_m({}, tilted).y() - 1e-4);
}

TEST_F(BodyEffects, HiddenObstacleHoldsTheBodyAboveItsGap) {
  constexpr double kGap_m = 5e-4;
  const Effects obstacle = {Effect("hidden_obstacle", {"body"},
                                   {{"gap_m", kGap_m}, {"nx", 0.0}, {"ny", 0.0}, {"nz", 1.0}})};
  const double healthy_m = Sag_m({});
  ASSERT_GT(healthy_m, 1.3 * kGap_m);
  const auto robot = Hung(obstacle);
  EXPECT_LT(-robot->MarkerPositions_m()(2, 0) + kTip_m.z(), healthy_m - 1e-4);
  EXPECT_NEAR(robot->positions_m().reshaped(3, robot->mesh().NodeCount()).row(2).minCoeff(),
              -kGap_m, 5e-5);
  ASSERT_EQ(robot->forces().size(), 1U);
  EXPECT_GT(robot->forces().front().force_N.z(), 0.0);
}

TEST_F(BodyEffects, WarmBodyGetsSofterWithTime) {
  scenario::Scenario scenario = PlainScenario();
  scenario.recordings.resize(1);
  scenario.recordings[0].duration_s = 10.0;
  VirtualRobot robot(beam_, scenario,
                     {Effect("temperature", {"body"}, {{"relative_E_change_at_end", -0.2}})}, 1);
  ASSERT_TRUE(robot.Start(5.0, NoInputs(0)).ok());
  const double cold_m = kTip_m.z() - robot.MarkerPositions_m()(2, 0);
  for (int k = 1; k <= 60; ++k) ASSERT_TRUE(robot.Advance(5.0 + 0.2 * k, NoInputs(0)).ok());
  EXPECT_NEAR((kTip_m.z() - robot.MarkerPositions_m()(2, 0)) / cold_m, 1.0 / 0.8, 0.01);
}

TEST_F(BodyEffects, StretchedRubberIsSofterTheSecondTimeUpToWhereItWasBefore) {
  const Effects mullins = {Effect("mullins", {"body"}, {{"r", 2.0}, {"m", 20.0}})};
  VirtualRobot robot(beam_, PlainScenario(), mullins, 1);
  ASSERT_TRUE(robot.Start(0.0, NoInputs(0)).ok());
  const auto sag_m = [&](double t_s, double mass_kg) {
    Inputs hung = NoInputs(0);
    hung.weights = {Weight(kTip_m, mass_kg)};
    EXPECT_TRUE(robot.Advance(t_s, hung).ok());
    EXPECT_TRUE(robot.Advance(t_s + 1.5, hung).ok());
    return kTip_m.z() - robot.MarkerPositions_m()(2, 0);
  };
  const double virgin_m = sag_m(2.0, 0.004);
  const double most_m = sag_m(6.0, 0.008);
  const double again_m = sag_m(10.0, 0.004);
  EXPECT_GT(again_m, 1.02 * virgin_m);
  EXPECT_NEAR(sag_m(14.0, 0.008) / most_m, 1.0, 0.02);
}

TEST_F(BodyEffects, SofteningDoesNotLagBehindTheLoad) {
  const Effects mullins = {Effect("mullins", {"body"}, {{"r", 2.0}, {"m", 20.0}})};
  const auto sag_after_m = [&](double time_step_s) {
    scenario::Scenario scenario = PlainScenario();
    scenario.motion.time_step_s = time_step_s;
    VirtualRobot robot(beam_, scenario, mullins, 1);
    EXPECT_TRUE(robot.Start(0.0, NoInputs(0)).ok());
    for (const auto& [t_s, mass_kg] : {std::pair{1.0, 0.008}, std::pair{2.0, 0.004}}) {
      Inputs hung = NoInputs(0);
      hung.weights = {Weight(kTip_m, mass_kg)};
      EXPECT_TRUE(robot.Advance(t_s, hung).ok());
    }
    return kTip_m.z() - robot.MarkerPositions_m()(2, 0);
  };
  const double in_many_steps_m = sag_after_m(0.01);
  EXPECT_NEAR(sag_after_m(0.25) / in_many_steps_m, 1.0, 0.005);
}

TEST_F(BodyEffects, MisplacedMarkerStandsOffByItsSizeWhereTheSeedSays) {
  const Effects misplaced = {Effect("marker_misplacement", {"marker:tip"}, {{"d_m", 0.002}})};
  beam_.gravity_m_s2.setZero();
  const Eigen::Vector3d moved_m = Moved_m(misplaced);
  EXPECT_NEAR(moved_m.norm(), 0.002, 1e-9);
  EXPECT_EQ(moved_m, Moved_m(misplaced));
  VirtualRobot other(beam_, PlainScenario(), misplaced, 4);
  ASSERT_TRUE(other.Start(0.0, NoInputs(0)).ok());
  EXPECT_GT((other.MarkerPositions_m().col(0) - kTip_m - moved_m).norm(), 1e-5);
}

}  // namespace
}  // namespace palpate::virtual_robot::test
