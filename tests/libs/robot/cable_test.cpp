// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/cable.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace palpate::robot {
namespace {

constexpr int kNodes = 9;
using Fixed = Eigen::Matrix<bool, 3, Eigen::Dynamic>;

Eigen::VectorXd RandomVector(int size, double amplitude, std::mt19937* engine) {
  Eigen::VectorXd values(size);
  for (double& value : values) {
    value = amplitude * (2.0 * static_cast<double>((*engine)()) / 4294967295.0 - 1.0);
  }
  return values;
}

/// A cable through three eyelets, neighbours of which share nodes; some weights are negative.
class CableTest : public testing::Test {
 protected:
  std::vector<fem::InterpolationWeights> eyelets_{{{0, 1, 2, 3}, {0.2, 0.3, 0.6, -0.1}},
                                                  {{2, 3, 4, 5}, {0.25, 0.25, 0.4, 0.1}},
                                                  {{3, 6, 7, 8}, {0.1, -0.2, 0.5, 0.6}}};
  Eigen::Vector3d pull_point_m_{0.1, -0.2, 0.3};
  std::mt19937 engine_{5};
  Eigen::VectorXd rest_m_ = RandomVector(3 * kNodes, 0.1, &engine_);
  Eigen::VectorXd x_m_ = rest_m_ + RandomVector(3 * kNodes, 0.02, &engine_);
  Cable cable_{pull_point_m_, eyelets_, rest_m_};
};

TEST_F(CableTest, LengthIsThatOfItsPath) {
  const Eigen::Matrix3Xd path = cable_.Path_m(x_m_);
  ASSERT_EQ(path.cols(), 4);
  EXPECT_EQ(path.col(0), pull_point_m_);
  double length = 0.0;
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE((path.col(k + 1) - eyelets_[static_cast<size_t>(k)].Position(x_m_)).norm(), 1e-15);
    length += (path.col(k + 1) - path.col(k)).norm();
  }
  EXPECT_NEAR(cable_.Value(x_m_), length, 1e-15);
  EXPECT_EQ(cable_.rest_length_m(), cable_.Value(rest_m_));
  EXPECT_EQ(cable_.Displacement_m(rest_m_), 0.0);
  EXPECT_NEAR(cable_.Displacement_m(x_m_), cable_.rest_length_m() - length, 1e-15);
}

TEST_F(CableTest, GradientIsTheDerivativeOfTheLength) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Ones(3 * kNodes);
  cable_.AddGradient(x_m_, 2.5, gradient);
  for (int i = 0; i < 3 * kNodes; ++i) {
    const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd::Unit(3 * kNodes, i);
    const double slope = (cable_.Value(x_m_ + step) - cable_.Value(x_m_ - step)) / 2e-5;
    EXPECT_NEAR(gradient[i], 1.0 + 2.5 * slope, 1e-8);
  }
}

TEST_F(CableTest, CurvatureIsTheDerivativeOfTheGradient) {
  fem::StiffnessMatrix K(Fixed::Constant(3, kNodes, false), cable_.CoupledPairs());
  cable_.BindTo(K);
  cable_.AddCurvature(x_m_, 3.0, K);
  const auto gradient = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd value = Eigen::VectorXd::Zero(3 * kNodes);
    cable_.AddGradient(x, 3.0, value);
    return value;
  };
  for (int i = 0; i < 3 * kNodes; ++i) {
    const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd::Unit(3 * kNodes, i);
    const Eigen::VectorXd expected = (gradient(x_m_ + step) - gradient(x_m_ - step)) / 2e-5;
    Eigen::VectorXd reduced(K.Size());
    K.Reduce(Eigen::VectorXd::Unit(3 * kNodes, i), reduced);
    Eigen::VectorXd column = Eigen::VectorXd::Zero(3 * kNodes);
    K.AddExpanded(K.Times(reduced), 1.0, column);
    EXPECT_LE((column - expected).norm(), 1e-5) << "direction " << i;  // of about 100 N/m
  }
}

TEST_F(CableTest, ForcesOnTheBodyAreThoseOfThePull) {
  const double tension_N = 4.0;
  Eigen::VectorXd internal = Eigen::VectorXd::Zero(3 * kNodes);
  cable_.AddGradient(x_m_, tension_N, internal);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int n = 0; n < kNodes; ++n) {
    sum -= internal.segment<3>(3 * n);
    const Eigen::Vector3d arm = x_m_.segment<3>(3 * n) - pull_point_m_;
    moment -= arm.cross(internal.segment<3>(3 * n));
  }
  // The ground pulls the cable, and the cable the body, towards the pull point.
  const Eigen::Vector3d first = cable_.Path_m(x_m_).col(1);
  EXPECT_LE((sum - tension_N * (pull_point_m_ - first).normalized()).norm(), 1e-13);
  EXPECT_LE(moment.norm(), 1e-13);
}

TEST_F(CableTest, ARigidMotionOfBodyAndPullPointChangesNothing) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(1.0, -2.0, 0.7).normalized()).toRotationMatrix();
  const Eigen::Vector3d by_m(0.3, 0.2, -0.5);
  const auto moved = [&](const Eigen::VectorXd& x) {
    return Eigen::VectorXd(((R * x.reshaped(3, kNodes)).colwise() + by_m).reshaped());
  };
  const Cable turned(R * pull_point_m_ + by_m, eyelets_, moved(rest_m_));
  EXPECT_NEAR(turned.Value(moved(x_m_)), cable_.Value(x_m_), 1e-14);
  EXPECT_NEAR(turned.rest_length_m(), cable_.rest_length_m(), 1e-14);
  Eigen::VectorXd here = Eigen::VectorXd::Zero(3 * kNodes);
  Eigen::VectorXd there = here;
  cable_.AddGradient(x_m_, 1.0, here);
  turned.AddGradient(moved(x_m_), 1.0, there);
  EXPECT_LE((there.reshaped(3, kNodes) - R * here.reshaped(3, kNodes)).norm(), 1e-13);
}

/// Force of each piece on the node where it ends, from a cable of one node an eyelet.
TEST_F(CableTest, FrictionTakesExpOfTheTurningAngleAtEachEyelet) {
  const std::vector<fem::InterpolationWeights> nodes{{{0}, {1.0}}, {{1}, {1.0}}, {{2}, {1.0}}};
  Eigen::VectorXd x_m(9);
  x_m << 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.5, 1.5, 0.0;  // turns by 90 and 45 degrees
  for (const std::vector<double>& sliding :
       {std::vector{1.0}, std::vector{-1.0}, std::vector{1.0, -0.5, 0.0}}) {
    Cable cable(Eigen::Vector3d::Zero(), nodes, x_m);
    cable.SetFriction({0.3, sliding});
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(9);
    cable.AddGradient(x_m, -2.0, force_N);
    const double last = sliding.size() == 1 ? sliding[0] : sliding[1];
    const double second_N = 2.0 * std::exp(-sliding[0] * 0.3 * std::numbers::pi / 2.0);
    const double third_N = second_N * std::exp(-last * 0.3 * std::numbers::pi / 4.0);
    const Eigen::Vector3d slanted = Eigen::Vector3d(1.0, 1.0, 0.0).normalized();
    EXPECT_LE((force_N.segment<3>(0) - Eigen::Vector3d(-2.0, second_N, 0.0)).norm(), 1e-14);
    EXPECT_LE(
        (force_N.segment<3>(3) - Eigen::Vector3d(0.0, -second_N, 0.0) - third_N * slanted).norm(),
        1e-14);
    EXPECT_LE((force_N.segment<3>(6) + third_N * slanted).norm(), 1e-14);
  }
}

TEST_F(CableTest, WithoutFrictionNothingChangesByABit) {
  Cable set = cable_;
  set.SetFriction({0.0, {-1.0}});
  Eigen::VectorXd a = Eigen::VectorXd::Zero(3 * kNodes);
  cable_.AddGradient(x_m_, 1.7, a);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(3 * kNodes);
  set.AddGradient(x_m_, 1.7, b);
  EXPECT_EQ(a, b);
  set.SetFriction({0.1});
  b.setZero();
  set.AddGradient(x_m_, 1.7, b);
  EXPECT_NE(a, b);
  EXPECT_EQ(set.Value(x_m_), cable_.Value(x_m_));
}

TEST_F(CableTest, APieceWithoutLengthHasNoDirection) {
  const Cable folded(pull_point_m_, {eyelets_[0], eyelets_[0], eyelets_[1]}, rest_m_);
  const Cable straight(pull_point_m_, {eyelets_[0], eyelets_[1]}, rest_m_);
  Eigen::VectorXd a = Eigen::VectorXd::Zero(3 * kNodes);
  Eigen::VectorXd b = a;
  folded.AddGradient(x_m_, 1.0, a);
  straight.AddGradient(x_m_, 1.0, b);
  EXPECT_EQ(a, b);
  EXPECT_EQ(folded.Value(x_m_), straight.Value(x_m_));
}

TEST(CableDeathTest, NeedsAnEyelet) {
  EXPECT_DEATH(Cable(Eigen::Vector3d::Zero(), {}, Eigen::VectorXd::Zero(3)), "eyelets_");
}

TEST(CableDeathTest, RefusesFrictionThatNoCableHas) {
  Cable cable(Eigen::Vector3d::UnitX(), {{{0}, {1.0}}}, Eigen::VectorXd::Zero(3));
  EXPECT_DEATH(cable.SetFriction({-0.1}), "coefficient");
  EXPECT_DEATH(cable.SetFriction({0.1, {1.1}}), "sliding");
  EXPECT_DEATH(cable.SetFriction({0.1, {1.0, 1.0}}), "count");
}

}  // namespace
}  // namespace palpate::robot
