// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "components/calibration/material_calibration.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/app/yaml.hpp"
#include "libs/experiment/capture_edit.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/geometry/rigid_registration.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::calibration {
namespace {

constexpr double kMarkerBias_m = 1e-3;  // what the hand-held start is good to

/// Dubied et al., RA-L 2022 (measured data; not part of the project).
std::filesystem::path BeamFolder() {
  const char* folder = std::getenv("PALPATE_DATA_DIR");
  return std::filesystem::path(folder != nullptr ? folder : PALPATE_SOURCE_DIR "/../shared/data") /
         "silicone_beam";
}

/// Tip markers at the end of a recording, in the robot frame: registered by where all six markers
/// were while the tip was held level by hand.
std::vector<experiment::MarkerMean> SettledTip(const std::string& file, double released_s) {
  experiment::CapturedMarkers captured = experiment::ReadCapturedCsv(BeamFolder() / file);
  experiment::Rotate(experiment::ParseAxes("z,-y,x"), captured);
  experiment::KeepMarkers({"Tip-1", "Tip-2", "Tip-3", "Base-1", "Base-2", "Base-3"}, captured);
  Eigen::Matrix3Xd nominal_m(3, 6);
  nominal_m << 0.0, 0.0, 0.0, -0.094, -0.094, -0.094,  //
      0.015, -0.006, 0.036, -0.01, 0.04, 0.04,         //
      0.036, 0.024, 0.006, -0.001, 0.0275, 0.0;
  const auto held = experiment::MeanOver(captured.tracks, {0.0, 0.5 * released_s});
  Eigen::Matrix3Xd held_m(3, 6);
  for (size_t m = 0; m < 6; ++m) held_m.col(static_cast<Eigen::Index>(m)) = held[m].mean_m;
  const geometry::Registration registration = geometry::RegisterRigid(held_m, nominal_m);
  EXPECT_TRUE(registration.status.ok());
  EXPECT_LT(registration.rms_m, 3e-3);
  const double end_s = captured.tracks.frames.back().t_s;
  auto settled = experiment::MeanOver(captured.tracks, {end_s - 0.5, end_s});
  settled.resize(3);
  for (experiment::MarkerMean& mean : settled) {
    const Eigen::Matrix3Xd point_m = mean.mean_m;
    mean.mean_m = registration.T_target_source.Apply(point_m);
  }
  return settled;
}

std::unique_ptr<robot::RobotModel> Beam() {
  return std::make_unique<robot::RobotModel>(robot::BuildRobotBody(robot::ReadRobotFile(
      std::filesystem::path(PALPATE_SOURCE_DIR) / "config/robots/beam.yaml", app::LoadYaml)));
}

MaterialCalibration CalibrateBySelfWeight(robot::RobotModel& model) {
  const auto tip = SettledTip("gravity_a.csv", 0.72);
  StaticObservation observation;
  observation.name = "gravity_a";
  observation.position_m.resize(9);
  for (size_t m = 0; m < 3; ++m) {
    observation.position_m.segment<3>(static_cast<Eigen::Index>(3 * m)) = tip[m].mean_m;
  }
  observation.variance_m2.setConstant(9, kMarkerBias_m * kMarkerBias_m);
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
  config.marker_bias_m = kMarkerBias_m;
  force_estimation::MarkerForceEstimator estimator(
      *model, config, fit.moduli[0].standard_error_Pa / fit.moduli[0].youngs_modulus_Pa);
  force_estimation::MarkerFrame frame;
  for (const experiment::MarkerMean& mean : SettledTip("load52g_a.csv", 0.45)) {
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
