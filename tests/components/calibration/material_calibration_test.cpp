// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/material_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/components/force_estimation/test_bodies.hpp"
#include "tests/support/robots.hpp"

namespace palpate::calibration {
namespace {

using force_estimation::BeamRobot;
using force_estimation::Build;
using force_estimation::Kind;
using force_estimation::LoadAt;
using force_estimation::NormalNoise;
using force_estimation::SolveTruth;

const Eigen::Vector3d kTip(0.0, 0.015, 0.03);
constexpr double kSigma_m = 2e-5;

/// The beam in two halves of different modulus.
robot::RobotDescription TwoPartBeam() {
  robot::RobotDescription robot = BeamRobot();
  robot.material.youngs_modulus_Pa = 250e3;
  robot.regions = {{"outer_half", {{-0.05, -1.0, -1.0}, {1.0, 1.0, 1.0}}, 150e3, {}}};
  return robot;
}

Eigen::VectorXd MarkersOf(const robot::RobotModel& model, const fem::StaticState& state) {
  const auto& markers = model.body().markers;
  Eigen::VectorXd positions_m(static_cast<Eigen::Index>(3 * markers.size()));
  for (size_t m = 0; m < markers.size(); ++m) {
    positions_m.segment<3>(static_cast<Eigen::Index>(3 * m)) =
        markers[m].point.weights.Position(state.x_m);
  }
  return positions_m;
}

/// What noise-free markers show of `model` as it is now.
StaticObservation ObserveModel(robot::RobotModel& model,
                               const std::vector<robot::ActuatorCommand>& cables,
                               const std::vector<robot::DeadLoad>& loads) {
  StaticObservation observation;
  observation.name = "made_up";
  observation.position_m = MarkersOf(model, SolveTruth(model, cables, loads));
  observation.variance_m2.setConstant(observation.position_m.size(), kSigma_m * kSigma_m);
  observation.cables = cables;
  observation.loads = loads;
  observation.gravity_m_s2 = model.gravity_m_s2();
  return observation;
}

/// Starts the fit from moduli that are wrong by these factors.
MaterialCalibration FitFrom(robot::RobotModel& model,
                            const std::vector<StaticObservation>& observations,
                            const std::vector<double>& factors) {
  MaterialCalibrationSettings settings;
  settings.materials.clear();
  for (size_t k = 0; k < factors.size(); ++k) {
    const auto material = static_cast<int>(k);
    settings.materials.push_back(material);
    model.SetYoungsModulus(material, factors[k] * model.body().materials[k].youngs_modulus_Pa);
  }
  return CalibrateMaterial(model, observations, settings);
}

void ExpectModuli(const MaterialCalibration& fit, const robot::RobotModel& model,
                  const std::vector<double>& expected_Pa) {
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ASSERT_EQ(fit.moduli.size(), expected_Pa.size());
  for (size_t k = 0; k < expected_Pa.size(); ++k) {
    EXPECT_EQ(fit.moduli[k].material, static_cast<int>(k));
    EXPECT_NEAR(fit.moduli[k].youngs_modulus_Pa, expected_Pa[k], 1e-6 * expected_Pa[k]);
    EXPECT_GT(fit.moduli[k].standard_error_Pa, 0.0);
    EXPECT_NEAR(model.body().materials[k].youngs_modulus_Pa, expected_Pa[k], 1e-6 * expected_Pa[k]);
    EXPECT_NEAR(fit.correlation(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)), 1.0,
                1e-12);
  }
  EXPECT_LT(fit.residual_rms_m, 1e-9);
}

TEST(CalibrateMaterial, RecoversTheModulusFromSelfWeight) {
  const auto model = Build(BeamRobot());
  const std::vector<StaticObservation> observations = {ObserveModel(*model, {}, {})};
  for (const double factor : {0.5, 1.8}) {
    model->SetYoungsModulus(0, 250e3);
    ExpectModuli(FitFrom(*model, observations, {factor}), *model, {250e3});
  }
}

TEST(CalibrateMaterial, RecoversTwoModuliFromWeightAndLoad) {
  const auto model = Build(TwoPartBeam());
  const std::vector<StaticObservation> observations = {
      ObserveModel(*model, {}, {}),
      ObserveModel(*model, {}, {LoadAt(*model, kTip, 0.005, {0.1, 0.3, -0.3})})};
  const MaterialCalibration fit = FitFrom(*model, observations, {1.5, 0.7});
  ExpectModuli(fit, *model, {250e3, 150e3});
  EXPECT_EQ(fit.degrees_of_freedom, 72 - 2);
  EXPECT_EQ(fit.residual_rms_of_observation_m.size(), 2U);
  EXPECT_LT(std::abs(fit.correlation(0, 1)), 1.0);
}

TEST(CalibrateMaterial, RecoversTheModulusFromCablesUnderTension) {
  const auto model = Build(test_support::QuickFourLegRobot());
  model->SetGravity(Eigen::Vector3d::Zero());
  const std::vector<StaticObservation> observations = {
      ObserveModel(*model, {{Kind::kTension, 2.0}, {Kind::kDisplacement, 0.002}, {}, {}}, {})};
  const double truth_Pa = model->body().materials[0].youngs_modulus_Pa;
  MaterialCalibrationSettings settings;
  const auto set_all = [&](double modulus_Pa) {
    for (size_t k = 0; k < model->body().materials.size(); ++k) {
      model->SetYoungsModulus(static_cast<int>(k), modulus_Pa);
    }
  };
  set_all(truth_Pa);
  model->SetYoungsModulus(0, 0.8 * truth_Pa);
  ExpectModuli(CalibrateMaterial(*model, observations, settings), *model, {truth_Pa});
}

class ReferenceShapes : public testing::TestWithParam<ReferenceShape> {};

TEST_P(ReferenceShapes, OffsetsOfTheMarkersDoNotMatter) {
  const auto model = Build(test_support::QuickFourLegRobot());
  const std::vector<robot::ActuatorCommand> cables = {{Kind::kDisplacement, 0.004}, {}, {}, {}};
  StaticObservation observation =
      ObserveModel(*model, cables, {LoadAt(*model, {0.0, 0.0, 0.125}, 0.008, {0.3, 0.0, -0.8})});
  observation.reference = GetParam();
  observation.reference_position_m =
      MarkersOf(*model, GetParam() == ReferenceShape::kUndeformed ? model->RestState()
                                                                  : SolveTruth(*model, cables, {}));
  std::mt19937 random(3);
  for (Eigen::Index m = 0; m < observation.position_m.size() / 3; ++m) {
    const Eigen::Vector3d offset_m = NormalNoise(2e-3, random);
    observation.position_m.segment<3>(3 * m) += offset_m;
    observation.reference_position_m.segment<3>(3 * m) += offset_m;
  }
  const double truth_Pa = model->body().materials[0].youngs_modulus_Pa;
  ExpectModuli(FitFrom(*model, {observation}, {1.4}), *model, {truth_Pa});
}

INSTANTIATE_TEST_SUITE_P(Shapes, ReferenceShapes,
                         testing::Values(ReferenceShape::kUndeformed, ReferenceShape::kEquilibrium),
                         [](const auto& one) {
                           return one.param == ReferenceShape::kUndeformed ? "Undeformed"
                                                                           : "Equilibrium";
                         });

TEST(CalibrateMaterial, StandardErrorKnowsThatTheReferenceMovesToo) {
  const auto model = Build(BeamRobot());
  const auto load = LoadAt(*model, kTip, 0.005, {0.0, 0.0, -0.1});
  const auto displacements_m = [&](double modulus_Pa) -> Eigen::VectorXd {
    model->SetYoungsModulus(0, modulus_Pa);
    return MarkersOf(*model, SolveTruth(*model, {}, {load})) -
           MarkersOf(*model, SolveTruth(*model, {}, {}));
  };
  constexpr double kStep = 1e-4;
  const Eigen::VectorXd derivative_m =
      (displacements_m(250e3 * std::exp(kStep)) - displacements_m(250e3 * std::exp(-kStep))) /
      (2.0 * kStep);
  model->SetYoungsModulus(0, 250e3);
  StaticObservation observation = ObserveModel(*model, {}, {load});
  observation.reference = ReferenceShape::kEquilibrium;
  observation.reference_position_m = MarkersOf(*model, SolveTruth(*model, {}, {}));
  const MaterialCalibration fit = CalibrateMaterial(*model, {observation}, {});
  ASSERT_TRUE(fit.status.ok());
  const double expected_Pa = 250e3 * kSigma_m / derivative_m.norm();
  EXPECT_NEAR(fit.moduli[0].standard_error_Pa, expected_Pa, 1e-4 * expected_Pa);
}

TEST(CalibrateMaterial, StandardErrorsHoldTheTruthAsOftenAsTheySay) {
  const auto model = Build(BeamRobot());
  const StaticObservation clean = ObserveModel(*model, {}, {});
  std::mt19937 random(20260102);
  constexpr int kDraws = 200;
  int covered = 0;
  double chi_squared = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    StaticObservation noisy = clean;
    for (Eigen::Index m = 0; m < noisy.position_m.size() / 3; ++m) {
      noisy.position_m.segment<3>(3 * m) += NormalNoise(kSigma_m, random);
    }
    const MaterialCalibration fit = CalibrateMaterial(*model, {noisy}, {});
    ASSERT_TRUE(fit.status.ok()) << fit.status.message();
    const double error_Pa = fit.moduli[0].youngs_modulus_Pa - 250e3;
    covered += std::abs(error_Pa) <= 1.96 * fit.moduli[0].standard_error_Pa ? 1 : 0;
    chi_squared += fit.chi_squared / kDraws;
  }
  EXPECT_GE(covered, 0.90 * kDraws);
  EXPECT_LE(covered, 0.99 * kDraws);
  EXPECT_NEAR(chi_squared, 35.0, 4.0 * std::sqrt(2.0 * 35.0 / kDraws));
}

TEST(CalibrateMaterial, ResidualBeyondTheNoiseWidensTheErrors) {
  const auto model = Build(BeamRobot());
  StaticObservation observation = ObserveModel(*model, {}, {});
  const double clean_Pa = FitFrom(*model, {observation}, {1.0}).moduli[0].standard_error_Pa;
  std::mt19937 random(1);
  for (Eigen::Index m = 0; m < observation.position_m.size() / 3; ++m) {
    observation.position_m.segment<3>(3 * m) += NormalNoise(10.0 * kSigma_m, random);
  }
  const MaterialCalibration fit = FitFrom(*model, {observation}, {1.0});
  const double inflation = fit.chi_squared / fit.degrees_of_freedom;
  ASSERT_GT(inflation, 50.0);
  EXPECT_NEAR(fit.moduli[0].standard_error_Pa, std::sqrt(inflation) * clean_Pa,
              0.1 * std::sqrt(inflation) * clean_Pa);
}

TEST(CalibrateMaterial, CoordinatesThatWereNotSeenAreLeftOut) {
  const auto model = Build(BeamRobot());
  StaticObservation observation = ObserveModel(*model, {}, {});
  observation.variance_m2.segment<3>(6).setConstant(-1.0);
  observation.position_m.segment<3>(6).setConstant(5.0);
  const MaterialCalibration fit = FitFrom(*model, {observation}, {1.3});
  ExpectModuli(fit, *model, {250e3});
  EXPECT_EQ(fit.degrees_of_freedom, 33 - 1);
  observation.variance_m2.setConstant(-1.0);
  EXPECT_EQ(FitFrom(*model, {observation}, {1.0}).status.code(), StatusCode::kUnobservable);
}

TEST(CalibrateMaterial, DisplacementDrivenWeightlessBodyDoesNotTellItsModulus) {
  const auto model = Build(test_support::QuickFourLegRobot());
  model->SetGravity(Eigen::Vector3d::Zero());
  StaticObservation observation = ObserveModel(
      *model, {{Kind::kDisplacement, 0.006}, {Kind::kDisplacement, 0.004}, {}, {}}, {});
  std::mt19937 random(2);
  for (Eigen::Index m = 0; m < observation.position_m.size() / 3; ++m) {
    observation.position_m.segment<3>(3 * m) += NormalNoise(kSigma_m, random);
  }
  std::vector<double> before_Pa;
  MaterialCalibrationSettings settings;
  settings.materials.clear();
  for (size_t k = 0; k < model->body().materials.size(); ++k) {
    settings.materials.push_back(static_cast<int>(k));
    before_Pa.push_back(model->body().materials[k].youngs_modulus_Pa);
  }
  const MaterialCalibration fit = CalibrateMaterial(*model, {observation}, settings);
  EXPECT_EQ(fit.status.code(), StatusCode::kUnobservable) << fit.status.message();
  EXPECT_THAT(fit.status.message(), testing::HasSubstr("and at most 0.5 counts"));
  EXPECT_TRUE(fit.moduli.empty());
  for (size_t k = 0; k < before_Pa.size(); ++k) {
    EXPECT_EQ(model->body().materials[k].youngs_modulus_Pa, before_Pa[k]) << k;
  }
}

TEST(CalibrateMaterial, NamesThePartThatTheDataDoNotDetermine) {
  const auto model = Build(TwoPartBeam());
  model->SetGravity(Eigen::Vector3d::Zero());
  // Nothing strains the outer half.
  const StaticObservation observation =
      ObserveModel(*model, {}, {LoadAt(*model, {-0.07, 0.015, 0.03}, 0.005, {0.0, 0.0, -2.0})});
  const MaterialCalibration fit = FitFrom(*model, {observation}, {1.1, 1.1});
  EXPECT_EQ(fit.status.code(), StatusCode::kUnobservable);
  EXPECT_THAT(fit.status.message(), testing::HasSubstr("region outer_half"));

  const StaticObservation weightless = ObserveModel(*model, {}, {});
  const MaterialCalibration body = FitFrom(*model, {weightless}, {1.1});
  EXPECT_EQ(body.status.code(), StatusCode::kUnobservable);
  EXPECT_THAT(body.status.message(), testing::HasSubstr("the body"));
}

TEST(CalibrateMaterial, FailureLeavesTheModelAlone) {
  const auto model = Build(test_support::QuickFourLegRobot());
  StaticObservation observation = ObserveModel(*model, {{Kind::kTension, 1.0}, {}, {}, {}}, {});
  observation.name = "too_tight";
  observation.cables[0].value = 1000.0;
  observation.gravity_m_s2 = {1.0, 2.0, 3.0};
  model->SetYoungsModulus(0, 123456.7);
  const Eigen::Vector3d gravity_m_s2 = model->gravity_m_s2();
  const MaterialCalibration fit = CalibrateMaterial(*model, {observation}, {});
  EXPECT_EQ(fit.status.code(), StatusCode::kTensionLimit);
  EXPECT_THAT(fit.status.message(), testing::HasSubstr("too_tight: no equilibrium was reached"));
  EXPECT_TRUE(fit.moduli.empty());
  EXPECT_EQ(model->body().materials[0].youngs_modulus_Pa, 123456.7);
  EXPECT_EQ(model->elastic_body().materials()[0].youngs_modulus_Pa, 123456.7);
  EXPECT_EQ(model->gravity_m_s2(), gravity_m_s2);
}

TEST(CalibrateMaterial, SuccessLeavesTheGravityAlone) {
  const auto model = Build(BeamRobot());
  StaticObservation tilted = ObserveModel(*model, {}, {});
  const Eigen::Vector3d gravity_m_s2(1.0, -2.0, -9.0);
  model->SetGravity(gravity_m_s2);
  ASSERT_TRUE(CalibrateMaterial(*model, {tilted}, {}).status.ok());
  EXPECT_EQ(model->gravity_m_s2(), gravity_m_s2);
}

TEST(CalibrateMaterial, SaysThatIterationsAreUsedUp) {
  const auto model = Build(BeamRobot());
  const StaticObservation observation = ObserveModel(*model, {}, {});
  model->SetYoungsModulus(0, 400e3);
  const MaterialCalibration fit = CalibrateMaterial(*model, {observation}, {.max_iterations = 1});
  EXPECT_EQ(fit.status.code(), StatusCode::kNotConverged);
  EXPECT_EQ(fit.iterations, 1);
  EXPECT_EQ(model->body().materials[0].youngs_modulus_Pa, 400e3);
}

}  // namespace
}  // namespace palpate::calibration
