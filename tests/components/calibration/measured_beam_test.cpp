// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/calibration/material_calibration.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "tests/components/calibration/measured_beam.hpp"

namespace palpate::calibration {
namespace {

MaterialCalibration CalibrateBySelfWeight(robot::RobotModel& model) {
  const auto tip = TipOf("gravity_a.csv", 0.72).settled;
  StaticObservation observation;
  observation.name = "gravity_a";
  observation.position_m.resize(9);
  for (size_t m = 0; m < 3; ++m) {
    observation.position_m.segment<3>(static_cast<Eigen::Index>(3 * m)) = tip[m].mean_m;
  }
  observation.variance_m2.setConstant(9, kHandHeld_m * kHandHeld_m);
  observation.gravity_m_s2 = model.gravity_m_s2();
  return CalibrateMaterial(model, {observation}, {});
}

TEST(MeasuredBeam, SelfWeightGivesTheModulusOfTheAuthors) {
  if (!std::filesystem::exists(BeamFolder())) GTEST_SKIP() << BeamFolder() << " is not there";
  const auto model = Beam();
  const MaterialCalibration fit = CalibrateBySelfWeight(*model);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  constexpr double kAuthors_Pa = 263.8e3;
  const FittedModulus& modulus = fit.moduli[0];
  EXPECT_NEAR(modulus.youngs_modulus_Pa, kAuthors_Pa, 0.15 * kAuthors_Pa);
  EXPECT_NEAR(modulus.youngs_modulus_Pa, kAuthors_Pa, 1.96 * modulus.standard_error_Pa);
}

TEST(MeasuredBeam, HungWeightLiesInItsInterval) {
  if (!std::filesystem::exists(BeamFolder())) GTEST_SKIP() << BeamFolder() << " is not there";
  const auto model = Beam();
  const MaterialCalibration fit = CalibrateBySelfWeight(*model);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  force_estimation::Config config;
  config.contacts = {"weight: 0, 0.015, 0.03, 0.005 along 0, 0, -1"};
  config.marker_bias_m = kHandHeld_m;
  force_estimation::MarkerForceEstimator estimator(
      *model, config, fit.moduli[0].standard_error_Pa / fit.moduli[0].youngs_modulus_Pa);
  force_estimation::MarkerFrame frame;
  for (const experiment::MarkerMean& mean : TipOf("load52g_a.csv", 0.45).settled) {
    frame.markers.push_back(
        {.valid = true, .position_m = mean.mean_m, .sigma_m = Eigen::Vector3d::Constant(1e-5)});
  }
  const force_estimation::ForceEstimate& estimate = estimator.Update(frame);
  ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
  const force_estimation::ContactForce& weight = estimate.contacts[0];
  EXPECT_NEAR(weight.force_N.norm(), 0.510, weight.ci95_N);
  EXPECT_LT(weight.ci95_N, 0.2);
  EXPECT_LT(weight.force_N.z(), 0.0);
}

}  // namespace
}  // namespace palpate::calibration
