// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/cloud/surface_in_view.hpp"
#include "libs/core/text.hpp"
#include "libs/linalg/cholesky.hpp"
#include "tests/components/calibration/cloud/cloud_scene.hpp"

namespace palpate::calibration {
namespace {

constexpr double kBiasSigma = 0.003;
constexpr int kPoseNumbers = 6;
constexpr int kSeeds = 6;
constexpr double kNoNoise_m = 1e-7;

/// A robot that is not quite the model, before a camera whose depth errs smoothly: what is found
/// errs as it says.
class DepthBiasOfAnotherRobot : public ::testing::Test {
 protected:
  /// As a seed draws them: the robot, the camera's error, and all noise.
  void Begin(std::uint64_t seed) {
    random_.seed(seed);
    robot_ = Mould();
    std::normal_distribution<double> normal(0.0, kBiasSigma);
    true_bias_.coefficients.resize(geometry::CountOf(true_bias_.basis));
    for (double& coefficient : true_bias_.coefficients) coefficient = normal(random_);
  }

  /// From a mould that is off by waves of 0.2 mm (RMS, 60 to 200 mm long), of a material that gives
  /// way by 3 % more (one sigma), with wider guides, in which cables sink in otherwise.
  std::unique_ptr<robot::RobotModel> Mould() {
    robot::RobotDescription description = QuickFourLegRobot();
    std::normal_distribution<double> normal;
    description.material.youngs_modulus_Pa *= 1.0 + 0.03 * normal(random_);
    for (robot::CableSettings& cable : description.cables) cable.guide_radius_m = 2.5e-3;
    robot::RobotBody body = robot::BuildRobotBody(description);
    constexpr int kWaves = 12;
    const Eigen::Matrix3Xd places_m = body.mesh.nodes_m;
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int wave = 0; wave < kWaves; ++wave) {
      const auto direction = [&] {
        const double x = normal(random_), y = normal(random_);
        return Eigen::Vector3d(x, y, normal(random_));
      };
      const double per_m = 2.0 * std::numbers::pi / (0.06 + 0.14 * unit(random_));
      const Eigen::RowVectorXd phase = per_m * direction().normalized().transpose() * places_m;
      const double begin = 2.0 * std::numbers::pi * unit(random_);
      body.mesh.nodes_m +=
          0.2e-3 * std::sqrt(2.0 / kWaves) * direction() * (phase.array() + begin).sin().matrix();
    }
    return std::make_unique<robot::RobotModel>(std::move(body),
                                               fem::StaticSettings{.relative_tolerance = 1e-12});
  }

  std::vector<CloudFrame> See(int first, double sigma_m = kDepthSigma_m) {
    std::vector<CloudFrame> seen;
    for (int f = first; f < first + 3; ++f) {
      std::vector<double> pulls_m;
      for (int c = 0; c < 4; ++c) pulls_m.push_back(1e-3 * (4.0 + (5 * f + 3 * c) % 7));
      seen.push_back(SeeCloud(*robot_, truth_, "pull " + std::to_string(f), pulls_m, pulls_m, 0.0,
                              random_, sigma_m));
      for (auto point_m : seen.back().cloud.points_m.colwise()) {
        point_m /= static_cast<float>(1.0 + true_bias_.At(point_m.cast<double>()));
      }
    }
    return seen;
  }

  CloudCalibration Fit(const std::vector<CloudFrame>& frames) {
    CloudCalibration fit =
        CalibrateFromClouds(*model_, frames, OffBy(truth_, 0.05, 0.01, random_), settings_);
    EXPECT_TRUE(fit.status.ok()) << fit.status.message();
    return fit;
  }

  static Eigen::VectorXd Difference(const geometry::RigidTransform& T_a, const Eigen::VectorXd& a,
                                    const geometry::RigidTransform& T_b, const Eigen::VectorXd& b) {
    const Eigen::AngleAxisd turn(T_a.rotation() * T_b.rotation().conjugate());
    Eigen::VectorXd difference(kPoseNumbers + a.size());
    difference << turn.angle() * turn.axis(), T_a.translation_m() - T_b.translation_m(), a - b;
    return difference;
  }

  /// RMS distance of the model's surface from the robot's as these clouds, which have no noise,
  /// show it with this calibration.
  double SurfacesApart_m(const JointCalibration& fit, const std::vector<CloudFrame>& noiseless) {
    double squares_m2 = 0.0;
    int count = 0;
    for (std::size_t f = 0; f < noiseless.size(); ++f) {
      SurfaceInView surface(model_->body());
      surface.TakeShape(fit.x_m[f]);
      surface.LookFrom(fit.T_robot_camera);
      for (const auto& seen_m : noiseless[f].cloud.points_m.colwise()) {
        const Eigen::Vector3d p_m = seen_m.cast<double>();
        const double bias = fit.depth_bias ? fit.depth_bias->At(p_m) : 0.0;
        const auto foot = surface.FootOf(fit.T_robot_camera * Eigen::Vector3d((1.0 + bias) * p_m));
        if (!foot || foot->openness < 1.0 || foot->distance_m > 5e-3) continue;
        squares_m2 += foot->distance_m * foot->distance_m;
        ++count;
      }
    }
    EXPECT_GT(count, 1000);
    return std::sqrt(squares_m2 / count);
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  std::unique_ptr<robot::RobotModel> robot_;
  geometry::RigidTransform truth_ = TruePose();
  geometry::DepthBiasMap true_bias_;
  CloudSettings settings_;
  std::mt19937_64 random_;
};

/// e' C^-1 e over pose and map is chi-squared distributed with mean 12 where the covariance is
/// right; with the noise alone in it, it is far larger.
TEST_F(DepthBiasOfAnotherRobot, PoseAndMapErrAsTheirCovarianceSays) {
  double sum = 0.0, without = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Begin(seed);
    const JointCalibration fit = Fit(See(0)).joint;
    ASSERT_TRUE(fit.depth_bias);
    const Eigen::VectorXd error = Difference(fit.T_robot_camera, fit.depth_bias->coefficients,
                                             truth_, true_bias_.coefficients);
    sum += error.dot(linalg::SolveSymmetric(fit.pose_and_bias_covariance, error)) / kSeeds;
    without += error.dot(linalg::SolveSymmetric(fit.depth_bias->covariance, error)) / kSeeds;
  }
  RecordProperty("mean_squared_error", FormatNumber(sum));
  RecordProperty("mean_squared_error_without_surface_errors", FormatNumber(without));
  EXPECT_GT(sum, 1.0);
  EXPECT_LT(sum, 24.0);
  EXPECT_GT(without, 48.0);
}

/// Two calibrations of one robot from other settings and noise differ as the covariances say that
/// go into the file: what the model's surface is wrong by is in both.
TEST_F(DepthBiasOfAnotherRobot, CalibrationsDifferAsTheFilesSay) {
  double sum = 0.0;
  for (std::uint64_t seed = 11; seed < 11 + kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Begin(seed);
    const JointCalibration a = Fit(See(0)).joint;
    const JointCalibration b = Fit(See(3)).joint;
    ASSERT_TRUE(a.depth_bias && b.depth_bias);
    const Eigen::VectorXd difference = Difference(a.T_robot_camera, a.depth_bias->coefficients,
                                                  b.T_robot_camera, b.depth_bias->coefficients);
    const Eigen::MatrixXd covariance = a.depth_bias->covariance + b.depth_bias->covariance;
    sum += difference.dot(linalg::SolveSymmetric(covariance, difference)) / kSeeds;
  }
  RecordProperty("mean_squared_difference", FormatNumber(sum));
  EXPECT_GT(sum, 4.0);
  EXPECT_LT(sum, 24.0);
}

TEST_F(DepthBiasOfAnotherRobot, TheMapLaysTheModelOnTheRobot) {
  for (std::uint64_t seed = 21; seed < 21 + kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Begin(seed);
    const std::vector<CloudFrame> frames = See(0);
    const std::vector<CloudFrame> noiseless = See(0, kNoNoise_m);
    settings_.fit_depth_bias = true;
    const double with_map_m = SurfacesApart_m(Fit(frames).joint, noiseless);
    settings_.fit_depth_bias = false;
    const double without_m = SurfacesApart_m(Fit(frames).joint, noiseless);
    RecordProperty("with_map_m_" + std::to_string(seed), FormatNumber(with_map_m));
    RecordProperty("without_m_" + std::to_string(seed), FormatNumber(without_m));
    EXPECT_LT(with_map_m, without_m);
    EXPECT_LT(with_map_m, 0.25e-3);
  }
}

}  // namespace
}  // namespace palpate::calibration
