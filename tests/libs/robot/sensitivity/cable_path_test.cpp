// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/cable_path.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "libs/robot/cable.hpp"

namespace palpate::robot {
namespace {

constexpr int kPoints = 5;
/// One eyelet slides in, one sticks, one slides out, and a knot.
const CableFriction kFriction{0.3, {1.0, 0.4, -1.0, 0.0}};

/// A path that turns at every eyelet, and a motion of its points.
class CablePathTest : public testing::Test {
 protected:
  CablePathTest() {
    points_m_ = Random();
    motion_m_ = Random();
    path_.Evaluate(points_m_, kFriction);
  }

  Eigen::Matrix3Xd Random() {
    Eigen::Matrix3Xd points(3, kPoints);
    for (double& value : points.reshaped()) {
      value = 0.1 * (2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.0);
    }
    return points;
  }

  static CablePath PathOf(const Eigen::Matrix3Xd& points_m, const CableFriction& friction) {
    CablePath path;
    path.Evaluate(points_m, friction);
    return path;
  }

  /// Central differences of order 4.
  static Eigen::Matrix3Xd Difference(const std::function<Eigen::Matrix3Xd(double)>& value) {
    const double h = 1e-4;
    return (8.0 * (value(h) - value(-h)) - (value(2.0 * h) - value(-2.0 * h))) / (12.0 * h);
  }

  std::mt19937 engine_{7};
  Eigen::Matrix3Xd points_m_;
  Eigen::Matrix3Xd motion_m_;
  CablePath path_;
};

TEST_F(CablePathTest, ForceAlongAMotionIsTheDerivativeOfTheForce) {
  Eigen::Matrix3Xd along;
  path_.ForceAlong(motion_m_, &along);
  const Eigen::Matrix3Xd expected =
      Difference([&](double by) { return PathOf(points_m_ + by * motion_m_, kFriction).force(); });
  EXPECT_LE((along - expected).norm(), 1e-9 * expected.norm());
}

TEST_F(CablePathTest, ForceAlongFrictionIsItsDerivative) {
  Eigen::Matrix3Xd along;
  path_.ForceAlongFriction(&along);
  const Eigen::Matrix3Xd expected = Difference([&](double by) {
    CableFriction friction = kFriction;
    friction.coefficient += by;
    return PathOf(points_m_, friction).force();
  });
  EXPECT_LE((along - expected).norm(), 1e-9 * expected.norm());
}

TEST_F(CablePathTest, ForceAlongFrictionAtAnEyeletIsItsDerivative) {
  for (std::size_t eyelet = 0; eyelet + 1 < kFriction.sliding.size(); ++eyelet) {
    Eigen::Matrix3Xd along;
    path_.ForceAlongFrictionAt(static_cast<Eigen::Index>(eyelet), &along);
    const Eigen::Matrix3Xd expected = Difference([&](double by) {
      CableFriction friction = kFriction;
      friction.sliding[eyelet] += by / friction.coefficient;
      return PathOf(points_m_, friction).force();
    });
    EXPECT_LE((along - expected).norm(), 1e-9 * expected.norm()) << eyelet;
  }
}

TEST_F(CablePathTest, WithoutFrictionTheForceIsMinusTheGradientOfTheLength) {
  const CablePath smooth = PathOf(points_m_, {});
  EXPECT_LE((smooth.force() + smooth.length_gradient()).norm(), 1e-15);
  EXPECT_EQ(path_.length_gradient(), smooth.length_gradient());
}

/// What is left of the derivative without the turns comes from a symmetric matrix.
TEST_F(CablePathTest, TurnsHoldAllThatIsNotSymmetric) {
  ASSERT_EQ(path_.TurnCount(), kPoints - 2);
  const auto without_turns = [&](const Eigen::Matrix3Xd& motion_m) {
    Eigen::Matrix3Xd along, force, angle;
    path_.ForceAlong(motion_m, &along);
    for (int turn = 0; turn < path_.TurnCount(); ++turn) {
      path_.Turn(turn, &force, &angle);
      along -= angle.cwiseProduct(motion_m).sum() * force;
    }
    return along;
  };
  const Eigen::Matrix3Xd other_m = Random();
  const double one = other_m.cwiseProduct(without_turns(motion_m_)).sum();
  const double two = motion_m_.cwiseProduct(without_turns(other_m)).sum();
  EXPECT_NEAR(one, two, 1e-12 * std::abs(one));
  Eigen::Matrix3Xd along_one, along_two;
  path_.ForceAlong(motion_m_, &along_one);
  path_.ForceAlong(other_m, &along_two);
  EXPECT_GT(
      std::abs(other_m.cwiseProduct(along_one).sum() - motion_m_.cwiseProduct(along_two).sum()),
      1e-3 * std::abs(one));
}

TEST_F(CablePathTest, IsThatOfTheCable) {
  std::vector<fem::InterpolationWeights> eyelets;
  for (int e = 1; e < kPoints; ++e) eyelets.push_back({{e}, {1.0}});
  const Eigen::VectorXd x_m = points_m_.reshaped();
  for (const CableFriction& friction :
       {CableFriction{0.3}, CableFriction{0.3, {-1.0}}, kFriction}) {
    Cable cable(points_m_.col(0), eyelets, x_m);
    cable.SetFriction(friction);
    Eigen::VectorXd nodal = Eigen::VectorXd::Zero(x_m.size());
    cable.AddGradient(x_m, -1.0, nodal);
    const CablePath path = PathOf(cable.Path_m(x_m), cable.friction());
    EXPECT_LE(
        (nodal.tail(3 * (kPoints - 1)) - path.force().rightCols(kPoints - 1).reshaped()).norm(),
        1e-14);
  }
}

TEST_F(CablePathTest, APieceWithoutLengthNeitherPullsNorTurns) {
  Eigen::Matrix3Xd folded_m(3, kPoints + 1);
  folded_m << points_m_.leftCols(3), points_m_.col(2), points_m_.rightCols(2);
  const CablePath folded = PathOf(folded_m, {0.3, {1.0, 0.4, 0.4, -1.0, 0.0}});
  EXPECT_EQ(folded.TurnCount(), path_.TurnCount());
  EXPECT_LE((folded.force().leftCols(2) - path_.force().leftCols(2)).norm(), 1e-15);
  EXPECT_LE((folded.force().col(2) + folded.force().col(3) - path_.force().col(2)).norm(), 1e-15);
  EXPECT_LE((folded.force().rightCols(2) - path_.force().rightCols(2)).norm(), 1e-15);
}

}  // namespace
}  // namespace palpate::robot
