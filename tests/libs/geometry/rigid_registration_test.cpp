// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/rigid_registration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace palpate::geometry {
namespace {

const RigidTransform kMotion(Eigen::Quaterniond(0.4, -0.7, 0.2, 0.5),
                             Eigen::Vector3d(0.3, -1.2, 0.8));

Eigen::Matrix3Xd Cloud(int count) {
  std::mt19937 random(11);
  std::normal_distribution<double> value;
  return Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return 0.1 * value(random); });
}

TEST(RegisterRigid, FindsTheMotionOfExactPairs) {
  const Eigen::Matrix3Xd source = Cloud(20);
  const Registration found = RegisterRigid(source, kMotion.Apply(source));
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_LT(found.T_target_source.rotation().angularDistance(kMotion.rotation()), 1e-12);
  EXPECT_TRUE(found.T_target_source.translation_m().isApprox(kMotion.translation_m(), 1e-12));
  EXPECT_LT(found.rms_m, 1e-14);
}

TEST(RegisterRigid, ThreePointsAreEnough) {
  const Eigen::Matrix3Xd source = Cloud(3);
  const Registration found = RegisterRigid(source, kMotion.Apply(source));
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_TRUE(found.T_target_source.Apply(source).isApprox(kMotion.Apply(source), 1e-12));
}

TEST(RegisterRigid, RefusesMirroredPoints) {
  const Eigen::Matrix3Xd source = Cloud(20);
  Eigen::Matrix3Xd mirrored = source;
  mirrored.row(0) *= -1.0;
  for (const Registration& found :
       {RegisterRigid(source, kMotion.Apply(mirrored)),
        RegisterRigid(source, kMotion.Apply(mirrored), Eigen::VectorXd::Constant(20, 1e-3))}) {
    EXPECT_EQ(found.status.code(), StatusCode::kInvalidInput);
    EXPECT_NE(found.status.message().find("mirrored"), std::string::npos);
    EXPECT_TRUE(found.mirrored);
    EXPECT_LT(found.mirrored_rms_m, 1e-12);
    EXPECT_GT(found.rms_m, 0.01);
  }
}

/// Not so near to the mirror image that it would be better; the rotation is still the best one.
TEST(RegisterRigid, NeverReflects) {
  Eigen::Matrix3Xd source = Cloud(20);
  Eigen::Matrix3Xd target = source;
  source.row(2) *= 0.3;
  target.row(2) *= -0.3;
  target.topRows<2>() += 0.3 * Cloud(40).rightCols(20).topRows<2>();
  const Registration found = RegisterRigid(source, target);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_LT(found.mirrored_rms_m, found.rms_m);
  EXPECT_NEAR(found.T_target_source.rotation().toRotationMatrix().determinant(), 1.0, 1e-12);
}

TEST(RegisterRigid, PlanePointsAreTurnedAndNotFlipped) {
  Eigen::Matrix3Xd source = Cloud(12);
  source.row(2).setZero();
  const Registration found = RegisterRigid(source, kMotion.Apply(source));
  ASSERT_TRUE(found.status.ok());
  EXPECT_LT(found.T_target_source.rotation().angularDistance(kMotion.rotation()), 1e-11);
}

TEST(RegisterRigid, NoSmallTurnOrShiftIsBetter) {
  const Eigen::Matrix3Xd source = Cloud(20);
  std::mt19937 random(12);
  std::normal_distribution<double> noise(0.0, 0.005);
  const Eigen::Matrix3Xd target =
      kMotion.Apply(source) + Eigen::Matrix3Xd::NullaryExpr(3, 20, [&] { return noise(random); });
  const Registration found = RegisterRigid(source, target);
  ASSERT_TRUE(found.status.ok());
  const auto rms = [&](const RigidTransform& T) {
    return std::sqrt((target - T.Apply(source)).squaredNorm() / 20.0);
  };
  EXPECT_NEAR(found.rms_m, rms(found.T_target_source), 1e-15);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
      const RigidTransform turn(Eigen::Quaterniond(Eigen::AngleAxisd(step, direction)),
                                Eigen::Vector3d::Zero());
      const RigidTransform shift(Eigen::Quaterniond::Identity(), step * direction);
      EXPECT_GT(rms(found.T_target_source * turn), found.rms_m);
      EXPECT_GT(rms(shift * found.T_target_source), found.rms_m);
    }
  }
}

/// Noise with this covariance in the source's points.
Eigen::Matrix3Xd Noise(const std::vector<Eigen::Matrix3d>& covariance_m2, std::mt19937& random) {
  std::normal_distribution<double> value;
  Eigen::Matrix3Xd noise(3, static_cast<Eigen::Index>(covariance_m2.size()));
  for (Eigen::Index k = 0; k < noise.cols(); ++k) {
    const Eigen::Matrix3d L =
        Eigen::LLT<Eigen::Matrix3d>(covariance_m2[static_cast<size_t>(k)]).matrixL();
    noise.col(k) = L * Eigen::Vector3d::NullaryExpr([&] { return value(random); });
  }
  return noise;
}

/// A depth camera's: long along the view, and of a size that grows from point to point.
std::vector<Eigen::Matrix3d> DepthNoise(int count) {
  std::vector<Eigen::Matrix3d> covariance_m2;
  for (int k = 0; k < count; ++k) {
    const double sigma_m = 1e-4 * (1 + k % 3);
    const Eigen::Vector3d sigmas_m(sigma_m, 2.0 * sigma_m, 10.0 * sigma_m);
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.4 * k, Eigen::Vector3d(1, 2, 3).normalized()));
    covariance_m2.push_back(turn * sigmas_m.cwiseAbs2().asDiagonal() * turn.transpose());
  }
  return covariance_m2;
}

double ChiSquared(const RigidTransform& T, const Eigen::Matrix3Xd& source,
                  const Eigen::Matrix3Xd& target,
                  const std::vector<Eigen::Matrix3d>& covariance_m2) {
  const Eigen::Matrix3Xd e = T.Inverse().Apply(target) - source;
  double sum = 0.0;
  for (Eigen::Index k = 0; k < e.cols(); ++k) {
    sum += e.col(k).dot(covariance_m2[static_cast<size_t>(k)].inverse() * e.col(k));
  }
  return sum;
}

TEST(RegisterRigidWithCovariances, NoSmallTurnOrShiftIsBetter) {
  std::mt19937 random(13);
  const auto covariance_m2 = DepthNoise(8);
  const Eigen::Matrix3Xd truth = Cloud(8);
  const Eigen::Matrix3Xd source = truth + Noise(covariance_m2, random);
  const Eigen::Matrix3Xd target = kMotion.Apply(truth);
  const Registration found = RegisterRigid(source, target, covariance_m2);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  const RigidTransform& best = found.T_target_source;
  EXPECT_NEAR(found.chi_squared, ChiSquared(best, source, target, covariance_m2),
              1e-9 * found.chi_squared);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-5, 1e-5}) {
      const Eigen::Vector3d moved = step * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d none = Eigen::Vector3d::Zero();
      EXPECT_GT(ChiSquared(Perturbed(best, moved, none), source, target, covariance_m2),
                found.chi_squared);
      EXPECT_GT(ChiSquared(Perturbed(best, none, moved), source, target, covariance_m2),
                found.chi_squared);
    }
  }
}

TEST(RegisterRigidWithCovariances, CovarianceIsThatOfTheErrors) {
  std::mt19937 random(14);
  const auto covariance_m2 = DepthNoise(8);
  const Eigen::Matrix3Xd truth = Cloud(8);
  const Eigen::Matrix3Xd target = kMotion.Apply(truth);
  constexpr int kRuns = 1000;
  double distance_squared = 0.0;  // Mahalanobis, 6 on average
  for (int run = 0; run < kRuns; ++run) {
    const Registration found =
        RegisterRigid(truth + Noise(covariance_m2, random), target, covariance_m2);
    ASSERT_TRUE(found.status.ok()) << found.status.message();
    const Eigen::AngleAxisd turn(kMotion.rotation() * found.T_target_source.rotation().conjugate());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(),
        kMotion.translation_m() - found.T_target_source.translation_m();
    distance_squared +=
        error.dot(Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(found.covariance).solve(error));
  }
  EXPECT_NEAR(distance_squared / kRuns, 6.0, 5.0 * std::sqrt(12.0 / kRuns));
}

TEST(RegisterRigidWithCovariances, EqualOnesGiveWhatNoneGive) {
  std::mt19937 random(15);
  const Eigen::Matrix3Xd source = Cloud(8);
  const std::vector<Eigen::Matrix3d> equal(8, 1e-6 * Eigen::Matrix3d::Identity());
  const Eigen::Matrix3Xd target = kMotion.Apply(source + Noise(equal, random));
  const Registration plain = RegisterRigid(source, target);
  const Registration weighted = RegisterRigid(source, target, Eigen::VectorXd::Constant(8, 1e-3));
  ASSERT_TRUE(plain.status.ok() && weighted.status.ok());
  EXPECT_LT(plain.T_target_source.rotation().angularDistance(weighted.T_target_source.rotation()),
            1e-10);
  const double scale = weighted.chi_squared / weighted.degrees_of_freedom;
  EXPECT_TRUE(plain.covariance.isApprox(scale * weighted.covariance, 1e-8));
}

/// Four points as much out of a plane as their errors: now and then a reflection fits better.
TEST(RegisterRigidWithCovariances, TakesNoNoiseForAMirror) {
  std::mt19937 random(16);
  const std::vector<Eigen::Matrix3d> equal(4, 1e-6 * Eigen::Matrix3d::Identity());
  Eigen::Matrix3Xd truth(3, 4);
  truth << 0.1, -0.1, 0.0, 0.0, 0.0, 0.0, 0.1, -0.1, 7e-4, 7e-4, -7e-4, -7e-4;
  int better = 0;
  for (int run = 0; run < 40000; ++run) {
    const Registration found =
        RegisterRigid(truth + Noise(equal, random), kMotion.Apply(truth), equal);
    ASSERT_TRUE(found.status.ok()) << found.status.message();
    better += 3.0 * found.mirrored_rms_m < found.rms_m ? 1 : 0;
  }
  EXPECT_GT(better, 0);
}

TEST(RegisterRigidWithCovariances, RefusesWhatIsNoCovariance) {
  const Eigen::Matrix3Xd source = Cloud(5);
  const auto code = [&](const auto& noise) {
    return RegisterRigid(source, source, noise).status.code();
  };
  std::vector<Eigen::Matrix3d> covariance_m2 = DepthNoise(5);
  covariance_m2[3](1, 1) = -1e-6;
  EXPECT_EQ(code(covariance_m2), StatusCode::kInvalidInput);
  EXPECT_EQ(code(DepthNoise(4)), StatusCode::kInvalidInput);
  EXPECT_EQ(code(Eigen::VectorXd::Zero(5).eval()), StatusCode::kInvalidInput);
  EXPECT_EQ(code(Eigen::VectorXd::Constant(5, std::nan("")).eval()), StatusCode::kInvalidInput);
}

TEST(RegisterRigidWithCovariances, RefusesPointsTooNearToOneLineForTheirErrors) {
  Eigen::Matrix3Xd source = Eigen::Vector3d(0.1, 0.2, 0.0) * Eigen::RowVectorXd::LinSpaced(5, 0, 1);
  source(2, 2) = 1e-3;
  const Eigen::Matrix3Xd target = kMotion.Apply(source);
  const auto with_sigma = [&](double sigma_m) {
    return RegisterRigid(source, target, Eigen::VectorXd::Constant(5, sigma_m)).status;
  };
  EXPECT_TRUE(with_sigma(1e-4).ok());
  EXPECT_EQ(with_sigma(1e-3).code(), StatusCode::kUnobservable);
  EXPECT_NE(with_sigma(1e-3).message().find("one line"), std::string::npos);
}

TEST(RegisterRigid, RefusesPointsInOnePlace) {
  const Eigen::Matrix3Xd same = Eigen::Vector3d(0.1, 0.2, 0.3).replicate(1, 6);
  const Registration found = RegisterRigid(same, same);
  EXPECT_EQ(found.status.code(), StatusCode::kUnobservable);
  EXPECT_NE(found.status.message().find("one place"), std::string::npos);
}

TEST(RegisterRigid, RefusesPointsOnOneLine) {
  Eigen::Matrix3Xd line = Eigen::Vector3d(1.0, 2.0, 3.0) * Eigen::RowVectorXd::LinSpaced(5, 0, 1);
  const Registration found = RegisterRigid(line, kMotion.Apply(line));
  EXPECT_EQ(found.status.code(), StatusCode::kUnobservable);
  EXPECT_NE(found.status.message().find("one line"), std::string::npos);
}

TEST(RegisterRigid, RefusesTooFewPoints) {
  EXPECT_EQ(RegisterRigid(Cloud(2), Cloud(2)).status.code(), StatusCode::kUnobservable);
  EXPECT_EQ(RegisterRigid(Cloud(0), Cloud(0)).status.code(), StatusCode::kUnobservable);
}

TEST(RegisterRigid, RefusesNanAndUnequalNumbers) {
  Eigen::Matrix3Xd source = Cloud(5);
  EXPECT_EQ(RegisterRigid(source, Cloud(6)).status.code(), StatusCode::kInvalidInput);
  source(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(RegisterRigid(source, Cloud(5)).status.code(), StatusCode::kInvalidInput);
}

}  // namespace
}  // namespace palpate::geometry
