// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "components/calibration/joint/joint_request.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"
#include "tests/components/calibration/measured_beam.hpp"

namespace palpate::calibration {
namespace {

CalibrationFrame FrameOf(const std::string& name, const std::vector<experiment::MarkerMean>& tip,
                         double sigma_m, const Eigen::Vector3d& gravity_m_s2) {
  CalibrationFrame frame{.name = name, .gravity_m_s2 = gravity_m_s2};
  for (int m = 0; m < 3; ++m) {
    frame.markers.push_back({.marker = m,
                             .position_m = tip[static_cast<size_t>(m)].mean_m,
                             .covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity()});
  }
  return frame;
}

/// E, gravity's direction and where the markers sit, from the beam under its own weight, and held
/// level by hand before.
JointCalibration FitSelfWeight(robot::RobotModel& model) {
  const BeamTip tip = TipOf("gravity_a.csv", 0.72);
  const JointRequest request{
      .pose = false, .moduli = {0}, .gravity_tilt_sigma_rad = 0.1, .marker_offset_sigma_m = 2e-3};
  const geometry::RigidTransform here;
  return CalibrateFrames(model,
                         {FrameOf("held", tip.held, kHandHeld_m, Eigen::Vector3d::Zero()),
                          FrameOf("settled", tip.settled, 1e-4, model.gravity_m_s2())},
                         &here, request);
}

/// z of the tip markers under self weight and `load_N` at the middle of the tip's upper edge.
Eigen::Vector3d HeightsUnder(robot::RobotModel& model, double load_N) {
  const fem::SurfacePatch patch = model.Patch({0.0, 0.015, 0.03}, 0.005);
  fem::StaticState state = model.RestState();
  const fem::StaticResult result = model.Solve({}, {{patch.weights, {0.0, 0.0, -load_N}}}, &state);
  EXPECT_TRUE(result.status.ok()) << result.status.message();
  Eigen::Vector3d heights_m;
  for (int m = 0; m < 3; ++m) {
    const auto& weights = model.body().markers[static_cast<size_t>(m)].point.weights;
    heights_m[m] = weights.Position(state.x_m).z();
  }
  return heights_m;
}

TEST(MeasuredBeamJointly, SelfWeightGivesTheModulusButNotGravitysDirection) {
  if (!std::filesystem::exists(BeamFolder())) GTEST_SKIP() << BeamFolder() << " is not there";
  const auto model = Beam();
  const JointCalibration fit = FitSelfWeight(*model);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  constexpr double kAuthors_Pa = 263.8e3;
  const FittedValue* modulus = ValueNamed(fit, "youngs_modulus:body");
  ASSERT_TRUE(modulus->determined);
  EXPECT_NEAR(modulus->value, kAuthors_Pa, 1.96 * modulus->standard_error);
  EXPECT_LT(modulus->standard_error, 0.1 * kAuthors_Pa);
  // Some hundredths of a radian move the tip by less than the hand held it still.
  for (const char* name : {"gravity_tilt:x", "gravity_tilt:y"}) {
    const FittedValue* tilt = ValueNamed(fit, name);
    EXPECT_FALSE(tilt->determined) << name << " " << tilt->value << " +- " << tilt->standard_error;
    EXPECT_THAT(tilt->what_would_tell, testing::HasSubstr("tilted"));
  }
  for (const char* axis : {"x", "y", "z"}) {
    EXPECT_TRUE(ValueNamed(fit, std::string("marker_offset:Tip-1:") + axis)->determined);
  }
}

TEST(MeasuredBeamJointly, PredictsTheHungWeightWithinItsErrors) {
  if (!std::filesystem::exists(BeamFolder())) GTEST_SKIP() << BeamFolder() << " is not there";
  constexpr double kHung_N = 0.510;
  constexpr double kDataSheet_Pa = 0.12e6;  // of a tensile test
  const auto model = Beam();
  const JointCalibration fit = FitSelfWeight(*model);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const FittedValue* modulus = ValueNamed(fit, "youngs_modulus:body");
  const Eigen::Vector3d predicted_m = HeightsUnder(*model, kHung_N);
  model->SetYoungsModulus(0, modulus->value + modulus->standard_error);
  const Eigen::Vector3d by_modulus_m = HeightsUnder(*model, kHung_N) - predicted_m;
  model->SetYoungsModulus(0, kDataSheet_Pa);
  const Eigen::Vector3d of_data_sheet_m = HeightsUnder(*model, kHung_N);
  const BeamTip tip = TipOf("load52g_a.csv", 0.45);
  for (int m = 0; m < 3; ++m) {
    const auto marker = static_cast<size_t>(m);
    const double rest_m = model->body().markers[marker].point.rest_m.z();
    const double sunk_m = tip.settled[marker].mean_m.z() - tip.held[marker].mean_m.z();
    const double sigma_m = std::hypot(by_modulus_m[m], kHandHeld_m);
    EXPECT_NEAR(rest_m + sunk_m, predicted_m[m], 1.96 * sigma_m) << "Tip-" << m + 1;
    EXPECT_GT(std::abs(rest_m + sunk_m - of_data_sheet_m[m]), 5.0 * sigma_m);
  }
}

}  // namespace
}  // namespace palpate::calibration
