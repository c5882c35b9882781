// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "libs/linalg/cholesky.hpp"
#include "tests/components/calibration/table_one.hpp"

namespace palpate::calibration {
namespace {

using Vector10d = Eigen::Matrix<double, 10, 1>;

/// The quick robot under the forces of Table I, seen by a camera at its pose.
class Algorithm1Laws : public testing::Test {
 protected:
  Algorithm1Laws()
      : model_(Build(QuickFourLegRobot())), truth_(SolveTensions(*model_, kTableOneForces_N)) {}

  std::vector<MarkerSighting> Seen(double sigma_m = 1e-4) const {
    return Sight(*model_, truth_, TableOnePose(), kNineMarkers, sigma_m);
  }

  std::unique_ptr<robot::RobotModel> model_;
  fem::StaticState truth_;
};

Eigen::Vector3d NormalNoise(const Eigen::Matrix3d& covariance_m2, std::mt19937& random) {
  std::normal_distribution<double> value;
  const Eigen::Matrix3d L = Eigen::LLT<Eigen::Matrix3d>(covariance_m2).matrixL();
  return L * Eigen::Vector3d::NullaryExpr([&] { return value(random); });
}

/// As of a depth camera: three times as much along its axis.
void MakeNoisy(std::vector<MarkerSighting>* sightings, std::mt19937& random) {
  for (MarkerSighting& sighting : *sightings) {
    sighting.covariance_m2(2, 2) *= 9.0;
    sighting.position_m += NormalNoise(sighting.covariance_m2, random);
  }
}

TEST_F(Algorithm1Laws, MovingTheCameraMovesThePoseOnly) {
  std::mt19937 random(21);
  std::vector<MarkerSighting> sightings = Seen();
  MakeNoisy(&sightings, random);
  const PoseAndInputs before = RunAlgorithm1(*model_, sightings);
  const geometry::RigidTransform T_new_old(Eigen::Quaterniond(0.3, 0.8, -0.2, 0.1),
                                           Eigen::Vector3d(0.2, -0.7, 0.4));
  const Eigen::Matrix3d R = T_new_old.rotation().toRotationMatrix();
  for (MarkerSighting& sighting : sightings) {
    sighting.position_m = T_new_old * sighting.position_m;
    sighting.covariance_m2 = (R * sighting.covariance_m2 * R.transpose()).eval();
  }
  const PoseAndInputs after = RunAlgorithm1(*model_, sightings);
  ASSERT_TRUE(before.status.ok() && after.status.ok());
  EXPECT_LT((before.lambda_a_N - after.lambda_a_N).norm(), 1e-7);
  EXPECT_NEAR(before.chi_squared, after.chi_squared, 1e-6);
  EXPECT_LT((before.residual_m - after.residual_m).norm(), 1e-9);
  const geometry::RigidTransform expected = before.T_robot_camera * T_new_old.Inverse();
  EXPECT_LT(expected.rotation().angularDistance(after.T_robot_camera.rotation()), 1e-7);
  EXPECT_LT((expected.translation_m() - after.T_robot_camera.translation_m()).norm(), 1e-7);
  EXPECT_TRUE(before.standard_error_N.isApprox(after.standard_error_N, 1e-6));
}

TEST_F(Algorithm1Laws, TheOrderOfTheMarkersDoesNotMatter) {
  std::mt19937 random(22);
  std::vector<MarkerSighting> sightings = Seen();
  MakeNoisy(&sightings, random);
  const PoseAndInputs before = RunAlgorithm1(*model_, sightings);
  std::rotate(sightings.begin(), sightings.begin() + 4, sightings.end());
  std::swap(sightings[1], sightings[6]);
  const PoseAndInputs after = RunAlgorithm1(*model_, sightings);
  ASSERT_TRUE(before.status.ok() && after.status.ok());
  EXPECT_LT((before.lambda_a_N - after.lambda_a_N).norm(), 1e-8);
  EXPECT_LT((before.T_robot_camera.translation_m() - after.T_robot_camera.translation_m()).norm(),
            1e-9);
  EXPECT_NEAR(before.chi_squared, after.chi_squared, 1e-8);
}

TEST_F(Algorithm1Laws, AMarkerThatIsHardlyKnownHardlyCounts) {
  std::vector<MarkerSighting> sightings = Seen();
  sightings[2].position_m += Eigen::Vector3d(0.02, -0.03, 0.01);
  sightings[2].covariance_m2 *= 1e8;
  const PoseAndInputs found = RunAlgorithm1(*model_, sightings);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_LT((found.lambda_a_N - kTableOneForces_N).norm(), 1e-3);
}

/// The markers' positions by finite differences of solved equilibria, which share nothing with the
/// compliances.
TEST_F(Algorithm1Laws, CovarianceIsThatOfTheLinearisedProblem) {
  constexpr double kSigma_m = 2e-4;
  const PoseAndInputs found = RunAlgorithm1(*model_, Seen(kSigma_m));
  ASSERT_TRUE(found.status.ok());
  const geometry::RigidTransform pose = TableOnePose();
  const std::vector<MarkerSighting> seen = Seen();
  Eigen::MatrixXd J(27, 10);
  const auto stacked = [](const std::vector<MarkerSighting>& sightings) {
    Eigen::VectorXd all(27);
    for (Eigen::Index k = 0; k < 9; ++k) {
      all.segment<3>(3 * k) = sightings[static_cast<size_t>(k)].position_m;
    }
    return all;
  };
  constexpr double kStep = 1e-4;
  for (int p = 0; p < 10; ++p) {
    const auto at = [&](double step) {
      Eigen::Vector4d tension_N = kTableOneForces_N;
      Eigen::Vector3d theta = Eigen::Vector3d::Zero(), tau = theta;
      if (p < 3) theta[p] = step;
      if (p >= 3 && p < 6) tau[p - 3] = step;
      if (p >= 6) tension_N[p - 6] += step;
      const geometry::RigidTransform moved(
          Eigen::Quaterniond(Eigen::AngleAxisd(theta.norm(), theta.stableNormalized())) *
              pose.rotation(),
          pose.translation_m() + tau);
      return stacked(Sight(*model_, SolveTensions(*model_, tension_N), moved, kNineMarkers));
    };
    J.col(p) = (at(kStep) - at(-kStep)) / (2.0 * kStep * kSigma_m);
  }
  const Eigen::MatrixXd expected = linalg::InverseSymmetric(J.transpose() * J);
  const Eigen::VectorXd scale = expected.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd difference =
      scale.asDiagonal() * (found.covariance - expected) * scale.asDiagonal();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-4) << difference;
}

TEST_F(Algorithm1Laws, StandardErrorsGrowWithTheNoise) {
  const PoseAndInputs one = RunAlgorithm1(*model_, Seen(1e-4));
  const PoseAndInputs three = RunAlgorithm1(*model_, Seen(3e-4));
  ASSERT_TRUE(one.status.ok() && three.status.ok());
  EXPECT_TRUE(three.standard_error_N.isApprox(3.0 * one.standard_error_N, 1e-6));
  EXPECT_TRUE(three.covariance.isApprox(9.0 * one.covariance, 1e-6));
}

TEST_F(Algorithm1Laws, StandardErrorsHoldTheTruthAsOftenAsTheySay) {
  constexpr int kSeeds = 100;
  std::mt19937 random(23);
  const geometry::RigidTransform pose = TableOnePose();
  double distance_squared = 0.0;  // Mahalanobis, 10 on average
  double chi_squared = 0.0;       // 27 - 10 on average
  int held = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    std::vector<MarkerSighting> sightings = Seen();
    MakeNoisy(&sightings, random);
    const PoseAndInputs found = RunAlgorithm1(*model_, sightings, {.tolerance_N = 3e-3});
    ASSERT_TRUE(found.status.ok()) << found.status.message();
    const Eigen::AngleAxisd turn(pose.rotation() * found.T_robot_camera.rotation().conjugate());
    Vector10d error;
    error << turn.angle() * turn.axis(),
        pose.translation_m() - found.T_robot_camera.translation_m(),
        kTableOneForces_N - found.lambda_a_N;
    distance_squared +=
        error.dot(linalg::SolveSymmetric(found.covariance, Eigen::VectorXd(error))) / kSeeds;
    chi_squared += found.chi_squared / kSeeds;
    held += static_cast<int>(
        (error.cwiseAbs().array() <= 1.96 * found.covariance.diagonal().cwiseSqrt().array())
            .count());
  }
  EXPECT_NEAR(distance_squared, 10.0, 4.0 * std::sqrt(20.0 / kSeeds));
  EXPECT_NEAR(chi_squared, 17.0, 4.0 * std::sqrt(34.0 / kSeeds));
  const double coverage = held / (10.0 * kSeeds);
  std::printf("95 %% intervals hold the truth in %.1f %%, mean distance squared %.2f of 10\n",
              100.0 * coverage, distance_squared);
  EXPECT_GT(coverage, 0.93);
  EXPECT_LT(coverage, 0.97);
}

}  // namespace
}  // namespace palpate::calibration
