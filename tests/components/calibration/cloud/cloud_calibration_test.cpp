// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/cloud_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "libs/core/text.hpp"
#include "libs/robot/calibrated_geometry.hpp"
#include "tests/components/calibration/cloud/cloud_scene.hpp"

namespace palpate::calibration {
namespace {

constexpr double kOthers = 0.2;  ///< share of points that are not the robot

const std::vector<double> kPulls_m = {0.004, 0.0, 0.008, 0.002};

CloudSettings PoseAlone() {
  CloudSettings settings;
  settings.request.actuator_offsets = false;
  settings.facet_error_share = 0.0;  // the clouds are of the model's own facets
  settings.depth_bias_sigma = 0.0;   // and err by their noise alone
  settings.surface_errors = NoSurfaceErrors();
  return settings;
}

class CloudCalibrationTest : public ::testing::Test {
 protected:
  /// Of the model itself under kPulls_m.
  CloudFrame See(double others) {
    return SeeCloud(*model_, truth_, "still", kPulls_m, kPulls_m, others, random_);
  }
  geometry::RigidTransform Start(double turn_rad, double shift_m) {
    return OffBy(truth_, turn_rad, shift_m, random_);
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  geometry::RigidTransform truth_ = TruePose();
  std::mt19937_64 random_{20261122};
};

TEST_F(CloudCalibrationTest, FindsThePoseFromStartsFarOffAmongOtherThings) {
  SCOPED_TRACE("seed 20261122");
  const CloudFrame frame = See(kOthers);
  double worst_m = 0.0;
  for (int k = 0; k < 20; ++k) {
    SCOPED_TRACE("start " + std::to_string(k));
    const CloudCalibration fit =
        CalibrateFromClouds(*model_, {frame}, Start(20.0 * kDegree, 0.05), PoseAlone());
    ASSERT_TRUE(fit.status.ok()) << fit.status.message();
    ExpectPose(fit.joint.T_robot_camera, truth_, 0.5 * kDegree, 1.5e-3);
    worst_m = std::max(worst_m,
                       (fit.joint.T_robot_camera.translation_m() - truth_.translation_m()).norm());
    EXPECT_GT(fit.matches.front().surface_covered, 0.95);
    EXPECT_LT(fit.matches.front().rms_m, 1.5 * kDepthSigma_m);
    EXPECT_GT(fit.matches.front().outlier_share, 0.1);
  }
  RecordProperty("worst_shift_m", FormatNumber(worst_m));
}

TEST_F(CloudCalibrationTest, FindsOffsetsOfTheActuatorsFromThreeFrames) {
  constexpr double kOffset_m = 1e-3;
  std::vector<CloudFrame> frames;
  for (const std::vector<double>& told_m :
       std::vector<std::vector<double>>{{0.006, 0.004, 0.010, 0.004},
                                        {0.010, 0.004, 0.004, 0.011},
                                        {0.005, 0.012, 0.006, 0.006}}) {
    std::vector<double> truth_m = told_m;
    for (double& pull_m : truth_m) pull_m += kOffset_m;
    frames.push_back(SeeCloud(*model_, truth_, "pull " + std::to_string(frames.size()), told_m,
                              truth_m, kOthers, random_));
  }
  CloudSettings settings = PoseAlone();
  settings.request.actuator_offsets = true;
  const CloudCalibration fit =
      CalibrateFromClouds(*model_, frames, Start(20.0 * kDegree, 0.05), settings);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectPose(fit.joint.T_robot_camera, truth_, 0.5 * kDegree, 1.5e-3);
  ASSERT_EQ(fit.joint.values.size(), 4u);
  for (const FittedValue& offset : fit.joint.values) {
    EXPECT_TRUE(offset.determined) << offset.name;
    EXPECT_NEAR(offset.value, kOffset_m, 0.3e-3) << offset.name;
    EXPECT_NEAR(offset.value, kOffset_m, 4.0 * offset.standard_error) << offset.name;
    EXPECT_LT(offset.standard_error, 0.15e-3) << offset.name;
  }
}

TEST_F(CloudCalibrationTest, FindsTheTensionOfACableOfWhichNothingIsTold) {
  const std::vector<double> pulls_m = {0.008, 0.0, 0.008, 0.002};
  CloudFrame frame = SeeCloud(*model_, truth_, "still", pulls_m, pulls_m, kOthers, random_);
  const fem::StaticState state = force_estimation::SolveTruth(*model_, frame.cables, {});
  const double tension_N = model_->StateOfActuator(0, state).tension_N;
  ASSERT_GT(tension_N, 0.5);
  frame.cables[0] = {};
  const CloudCalibration fit =
      CalibrateFromClouds(*model_, {frame}, Start(5.0 * kDegree, 0.01), PoseAlone());
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectPose(fit.joint.T_robot_camera, truth_, 0.5 * kDegree, 1.5e-3);
  const FittedValue& found = fit.joint.values.front();
  EXPECT_TRUE(found.determined);
  EXPECT_NEAR(found.value, tension_N, 0.1 * tension_N);
}

/// e' C^-1 e over the six of the pose is chi-squared distributed with mean 6, deviation 3.5.
TEST_F(CloudCalibrationTest, StandardErrorsSayHowFarThePoseIsOff) {
  constexpr int kClouds = 12;
  double sum = 0.0;
  for (int k = 0; k < kClouds; ++k) {
    const CloudCalibration fit =
        CalibrateFromClouds(*model_, {See(0.0)}, Start(2.0 * kDegree, 0.003), PoseAlone());
    ASSERT_TRUE(fit.status.ok()) << fit.status.message();
    const geometry::RigidTransform& found = fit.joint.T_robot_camera;
    const Eigen::AngleAxisd turn(truth_.rotation() * found.rotation().conjugate());
    PoseChange error;
    error << turn.angle() * turn.axis(), truth_.translation_m() - found.translation_m();
    sum +=
        error.dot(Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(fit.joint.pose_covariance).solve(error));
  }
  RecordProperty("mean_squared_error", FormatNumber(sum / kClouds));
  EXPECT_GT(sum / kClouds, 3.0);
  EXPECT_LT(sum / kClouds, 10.0);
}

/// The truth has other elements, which bend more easily. That turns the picture by more than the
/// noise, and a camera 0.5 m away moves by 5 mm for each half degree: at the robot it must be
/// right.
TEST_F(CloudCalibrationTest, FindsThePoseOfARobotThatIsNotQuiteTheModel) {
  const auto quadratic = Build(FourLegRobot());
  std::vector<CloudFrame> frames;
  for (const std::vector<double>& pulls_m : {std::vector<double>(4, 0.0), kPulls_m}) {
    frames.push_back(SeeCloud(*quadratic, truth_, "pull " + std::to_string(frames.size()), pulls_m,
                              pulls_m, kOthers, random_));
  }
  CloudSettings settings = PoseAlone();
  settings.facet_error_share = 1.0;
  const CloudCalibration fit =
      CalibrateFromClouds(*model_, frames, Start(20.0 * kDegree, 0.05), settings);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectPose(fit.joint.T_robot_camera, truth_, 0.5 * kDegree, 4e-3);
  const Eigen::Vector3d middle_m(0.0, 0.0, 0.065);
  const Eigen::Vector3d found_m = fit.joint.T_robot_camera * (truth_.Inverse() * middle_m);
  EXPECT_LT((found_m - middle_m).norm(), 1.5e-3);
}

TEST_F(CloudCalibrationTest, RefusesARobotOfAnotherSizeAndNamesBoth) {
  for (const double scale : {1.4, 0.75, 1.15}) {
    SCOPED_TRACE(scale);
    robot::RobotBody body = robot::BuildRobotBody(QuickFourLegRobot());
    robot::ScaleBody(scale, &body);
    robot::RobotModel larger(std::move(body));
    std::vector<double> pulls_m = kPulls_m;
    for (double& pull_m : pulls_m) pull_m *= scale;
    const CloudFrame frame = SeeCloud(larger, truth_, "still", pulls_m, pulls_m, kOthers, random_);
    const CloudCalibration fit =
        CalibrateFromClouds(*model_, {frame}, Start(10.0 * kDegree, 0.02), PoseAlone());
    EXPECT_EQ(fit.status.code(), StatusCode::kInvalidInput);
    const std::string& said = fit.status.message();
    EXPECT_THAT(said, testing::HasSubstr("the sizes disagree: points of the surface are "));
    const std::size_t at = said.find("or one ");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_NEAR(std::stod(said.substr(at + 7)), scale, 0.02 * scale) << said;
  }
}

TEST_F(CloudCalibrationTest, SaysNothingOfSizesWhereTheRobotIsAsLargeAsItsFileSays) {
  CloudSettings settings = PoseAlone();
  settings.max_rounds = 1;
  const CloudCalibration fit =
      CalibrateFromClouds(*model_, {See(kOthers)}, Start(0.02, 0.005), settings);
  EXPECT_EQ(fit.status.code(), StatusCode::kNotConverged);
  EXPECT_THAT(fit.status.message(), testing::Not(testing::HasSubstr("sizes")));
}

TEST_F(CloudCalibrationTest, RefusesAStartThatIsTooFarOff) {
  const geometry::RigidTransform upside_down(
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX())),
      {0.0, 0.0, 0.13});
  const CloudCalibration fit =
      CalibrateFromClouds(*model_, {See(0.0)}, upside_down * truth_, PoseAlone());
  EXPECT_EQ(fit.status.code(), StatusCode::kNotConverged);
}

TEST_F(CloudCalibrationTest, RefusesAPoseFartherFromTheStartThanItMayBe) {
  CloudSettings settings = PoseAlone();
  settings.search.farthest_m = 0.005;
  const CloudCalibration fit = CalibrateFromClouds(*model_, {See(0.0)}, Start(0.0, 0.02), settings);
  EXPECT_EQ(fit.status.code(), StatusCode::kNotConverged);
}

TEST_F(CloudCalibrationTest, RefusesPointsThatLieTooFarOffTheSurface) {
  CloudSettings settings = PoseAlone();
  settings.most_rms_m = 0.1 * kDepthSigma_m;
  const CloudCalibration fit = CalibrateFromClouds(*model_, {See(0.0)}, truth_, settings);
  EXPECT_EQ(fit.status.code(), StatusCode::kInvalidInput);
}

TEST_F(CloudCalibrationTest, SaysThatItsRoundsAreUsedUp) {
  CloudSettings settings = PoseAlone();
  settings.max_rounds = 1;
  const CloudCalibration fit =
      CalibrateFromClouds(*model_, {See(0.0)}, Start(0.02, 0.005), settings);
  EXPECT_EQ(fit.status.code(), StatusCode::kNotConverged);
}

TEST_F(CloudCalibrationTest, RefusesTooFewPoints) {
  CloudFrame frame = See(0.0);
  frame.cloud.points_m = frame.cloud.points_m.leftCols(100).eval();
  frame.cloud.sigma_m = frame.cloud.sigma_m.head(100).eval();
  const CloudCalibration fit = CalibrateFromClouds(*model_, {frame}, truth_);
  EXPECT_EQ(fit.status.code(), StatusCode::kNoRobotSeen);
}

TEST_F(CloudCalibrationTest, RefusesInputThatIsNone) {
  const auto code = [&](const std::vector<CloudFrame>& frames) {
    return CalibrateFromClouds(*model_, frames, truth_).status.code();
  };
  const CloudFrame good = See(0.0);
  EXPECT_EQ(code({}), StatusCode::kInvalidInput);
  CloudFrame bad = good;
  bad.cloud.points_m(1, 7) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(code({good, bad}), StatusCode::kInvalidInput);
  bad = good;
  bad.cloud.points_m(2, 7) = -0.3f;
  EXPECT_EQ(code({bad}), StatusCode::kInvalidInput);
  bad = good;
  bad.cloud.sigma_m[7] = 0.0f;
  EXPECT_EQ(code({bad}), StatusCode::kInvalidInput);
  bad = good;
  bad.cloud.sigma_m = bad.cloud.sigma_m.head(7).eval();
  EXPECT_EQ(code({bad}), StatusCode::kInvalidInput);
  bad = good;
  bad.cables.pop_back();
  EXPECT_EQ(code({bad}), StatusCode::kInvalidInput);
}

}  // namespace
}  // namespace palpate::calibration
