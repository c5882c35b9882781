// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "libs/core/text.hpp"
#include "libs/linalg/cholesky.hpp"
#include "tests/components/calibration/cloud/cloud_scene.hpp"

namespace palpate::calibration {
namespace {

constexpr double kSigma = 0.003;
constexpr int kPoseRows = 6;

/// Clouds at several settings of the cables, of a camera whose depth errs smoothly.
class DepthBiasOfClouds : public ::testing::Test {
 protected:
  DepthBiasOfClouds() {
    settings_.fit_depth_bias = true;
    settings_.request.actuator_offsets = false;
    settings_.facet_error_share = 0.0;  // the clouds are of the model's own surface
    settings_.surface_errors = NoSurfaceErrors();
    settings_.depth_bias_sigma = kSigma;
  }

  void DrawBias() {
    std::normal_distribution<double> normal(0.0, kSigma);
    true_bias_.coefficients.resize(geometry::CountOf(true_bias_.basis));
    for (double& coefficient : true_bias_.coefficients) coefficient = normal(random_);
  }

  std::vector<CloudFrame> See(int frames) {
    std::vector<CloudFrame> seen;
    for (int f = 0; f < frames; ++f) {
      std::vector<double> pulls_m;
      for (int c = 0; c < 4; ++c) pulls_m.push_back(1e-3 * (2.0 + (5 * f + 3 * c) % 9));
      seen.push_back(
          SeeCloud(*model_, truth_, "pull " + std::to_string(f), pulls_m, pulls_m, 0.1, random_));
      auto points_m = seen.back().cloud.points_m.colwise();
      for (auto point_m : points_m) {
        point_m /= static_cast<float>(1.0 + true_bias_.At(point_m.cast<double>()));
      }
    }
    return seen;
  }

  CloudCalibration Fit(const std::vector<CloudFrame>& frames) {
    return CalibrateFromClouds(*model_, frames, OffBy(truth_, 20.0 * kDegree, 0.05, random_),
                               settings_);
  }

  double TurnOf(const CloudCalibration& fit) const {
    return fit.joint.T_robot_camera.rotation().angularDistance(truth_.rotation());
  }

  /// RMS distance of a cloud's points from where they are.
  double OffBy_m(const JointCalibration& fit, const rgbd::SensedCloud& cloud) const {
    double squares_m2 = 0.0;
    for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
      const Eigen::Vector3d p_m = cloud.points_m.col(k).cast<double>();
      const double found = fit.depth_bias ? fit.depth_bias->At(p_m) : 0.0;
      const Eigen::Vector3d found_m = fit.T_robot_camera * Eigen::Vector3d((1.0 + found) * p_m);
      const Eigen::Vector3d true_m = truth_ * Eigen::Vector3d((1.0 + true_bias_.At(p_m)) * p_m);
      squares_m2 += (found_m - true_m).squaredNorm();
    }
    return std::sqrt(squares_m2 / static_cast<double>(cloud.Count()));
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  geometry::RigidTransform truth_ = TruePose();
  geometry::DepthBiasMap true_bias_;
  CloudSettings settings_;
  std::mt19937_64 random_{20261122};
};

/// The limits from its starts, on noisy clouds with a smooth error of the depth.
TEST_F(DepthBiasOfClouds, IsFoundWithThePoseAndMakesItRight) {
  double found_rad = 0.0, blind_rad = 0.0, found_m = 0.0, blind_m = 0.0;
  for (int k = 0; k < 3; ++k) {
    DrawBias();
    const std::vector<CloudFrame> frames = See(3);
    settings_.fit_depth_bias = true;
    const CloudCalibration fit = Fit(frames);
    ASSERT_TRUE(fit.status.ok()) << fit.status.message();
    ASSERT_TRUE(fit.joint.depth_bias);
    ExpectPose(fit.joint.T_robot_camera, truth_, 0.5 * kDegree, 1.5e-3);
    settings_.fit_depth_bias = false;
    const CloudCalibration blind = Fit(frames);
    ASSERT_TRUE(blind.status.ok()) << blind.status.message();
    EXPECT_FALSE(blind.joint.depth_bias);
    found_rad = std::max(found_rad, TurnOf(fit));
    blind_rad = std::max(blind_rad, TurnOf(blind));
    found_m = std::max(found_m, OffBy_m(fit.joint, frames.front().cloud));
    blind_m = std::max(blind_m, OffBy_m(blind.joint, frames.front().cloud));
  }
  EXPECT_LT(found_rad, 0.15 * kDegree);
  EXPECT_LT(found_rad, 0.4 * blind_rad);
  EXPECT_LT(found_m, 0.2e-3);
  EXPECT_LT(found_m, 0.4 * blind_m);
  RecordProperty("found_deg", FormatNumber(found_rad / kDegree));
  RecordProperty("blind_deg", FormatNumber(blind_rad / kDegree));
  RecordProperty("found_m", FormatNumber(found_m));
  RecordProperty("blind_m", FormatNumber(blind_m));
}

/// e' C^-1 e over pose and map is chi-squared distributed with mean 12, deviation 4.9.
TEST_F(DepthBiasOfClouds, ErrsAsItsCovarianceSays) {
  constexpr int kDraws = 6;
  double sum = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    DrawBias();
    const CloudCalibration fit = Fit(See(2));
    ASSERT_TRUE(fit.status.ok()) << fit.status.message();
    const geometry::RigidTransform& found = fit.joint.T_robot_camera;
    const Eigen::AngleAxisd turn(found.rotation() * truth_.rotation().conjugate());
    Eigen::VectorXd error(kPoseRows + true_bias_.coefficients.size());
    error << turn.angle() * turn.axis(), found.translation_m() - truth_.translation_m(),
        fit.joint.depth_bias->coefficients - true_bias_.coefficients;
    sum += error.dot(linalg::SolveSymmetric(fit.joint.pose_and_bias_covariance, error));
    EXPECT_TRUE(fit.joint.depth_bias->covariance.isApprox(fit.joint.pose_and_bias_covariance));
  }
  RecordProperty("mean_squared_error", FormatNumber(sum / kDraws));
  EXPECT_GT(sum / kDraws, 7.0);
  EXPECT_LT(sum / kDraws, 18.0);
}

/// What a cloud does not determine keeps its prior and is named; the standard error of the pose
/// includes it.
TEST_F(DepthBiasOfClouds, WhatIsNotToldIsNamedAndCountsInTheErrorOfThePose) {
  true_bias_.coefficients = Eigen::VectorXd::Unit(6, 1) * 1e-4;
  settings_.depth_bias_sigma = 1e-4;  // a tenth of what clouds tell
  const CloudCalibration fit = Fit(See(1));
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const FittedValue* slope = ValueNamed(fit.joint, "depth_bias:x");
  ASSERT_NE(slope, nullptr);
  EXPECT_FALSE(slope->determined);
  EXPECT_EQ(slope->value, 0.0);
  EXPECT_NEAR(slope->standard_error, 1e-4, 1e-12);
  EXPECT_FALSE(slope->what_would_tell.empty());
  const Eigen::MatrixXd& covariance = fit.joint.pose_and_bias_covariance;
  EXPECT_TRUE(covariance.topLeftCorner(6, 6).isApprox(fit.joint.pose_covariance, 1e-9));
  EXPECT_GT(covariance.topRightCorner(6, 6).cwiseAbs().maxCoeff(), 0.0);
}

TEST_F(DepthBiasOfClouds, CountsInTheErrorOfThePoseWhereItIsNotLookedFor) {
  true_bias_.coefficients = Eigen::VectorXd::Unit(6, 1) * kSigma;
  const std::vector<CloudFrame> frames = See(1);
  settings_.fit_depth_bias = false;
  const CloudCalibration fit = Fit(frames);
  EXPECT_FALSE(fit.joint.depth_bias);
  settings_.depth_bias_sigma = 0.0;
  const CloudCalibration blind = Fit(frames);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const auto error_rad = [](const CloudCalibration& of) {
    return of.joint.pose_covariance.diagonal().head<3>().cwiseSqrt().norm();
  };
  EXPECT_GT(TurnOf(blind), 3.0 * error_rad(blind));
  EXPECT_LT(TurnOf(fit), 3.0 * error_rad(fit));
  EXPECT_LT(error_rad(fit), 0.03);
  EXPECT_TRUE(fit.joint.values.empty());
}

}  // namespace
}  // namespace palpate::calibration
