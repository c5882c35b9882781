// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/kept_stress.hpp"

#include <gtest/gtest.h>

#include <random>

#include "libs/robot/robot_model.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

class KeptStressLaw : public testing::Test {
 protected:
  KeptStressLaw() : model_(body_, {}, {}, {&kept_}) {
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<float> one(-1.0F, 1.0F);
    kept_.Set(points_, PointStresses::NullaryExpr(6, points_.PointCount(),
                                                  [&] { return 1e3F * one(random); }));
    x_m_ = model_.RestState().x_m;
    for (double& value : x_m_) value += 2e-4 * static_cast<double>(one(random));
    direction_ =
        Eigen::VectorXd::NullaryExpr(x_m_.size(), [&] { return static_cast<double>(one(random)); });
  }

  Eigen::VectorXd Gradient(const Eigen::VectorXd& x_m) const {
    Eigen::VectorXd nodal = Eigen::VectorXd::Zero(x_m.size());
    kept_.AddGradient(x_m, 1.0, nodal);
    return nodal;
  }

  static constexpr unsigned kSeed = 3;
  robot::RobotBody body_ = SmallRobot();
  fem::PointStress points_{body_.mesh, body_.material_of_cell};
  KeptStress kept_{body_.mesh};
  robot::RobotModel model_;
  Eigen::VectorXd x_m_;
  Eigen::VectorXd direction_;
};

TEST_F(KeptStressLaw, ItsForcesAreTheSlopeOfItsEnergy) {
  constexpr double kStep_m = 1e-4;
  const double difference_N =
      (kept_.Value(x_m_ + kStep_m * direction_) - kept_.Value(x_m_ - kStep_m * direction_)) /
      (2.0 * kStep_m);
  EXPECT_NEAR(Gradient(x_m_).dot(direction_), difference_N, 1e-8 * std::abs(difference_N))
      << "seed " << kSeed;
}

TEST_F(KeptStressLaw, ItsCurvatureIsTheSlopeOfItsForces) {
  fem::Linearisation& linearisation = model_.linearisation();
  const auto tangent_on = [&](double multiplier) {
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(model_.ActuatorCount() + 1);
    multipliers.tail<1>().setConstant(multiplier);
    EXPECT_TRUE(linearisation.Update(x_m_, multipliers, 0.0 * x_m_).ok());
    Eigen::VectorXd reduced(linearisation.Size());
    linearisation.matrix().Reduce(direction_, reduced);
    return linearisation.matrix().Times(reduced);
  };
  const Eigen::VectorXd of_stress = tangent_on(1.0) - tangent_on(0.0);
  Eigen::VectorXd free = Eigen::VectorXd::Zero(x_m_.size());
  Eigen::VectorXd reduced(linearisation.Size());
  linearisation.matrix().Reduce(direction_, reduced);
  linearisation.matrix().AddExpanded(reduced, 1.0, free);
  linearisation.matrix().Reduce(Gradient(x_m_ + free) - Gradient(x_m_), reduced);
  EXPECT_LT((of_stress - reduced).norm(), 1e-8 * reduced.norm()) << "seed " << kSeed;
}

TEST_F(KeptStressLaw, TurnsWithTheBodyAndPushesNobodyAway) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.3, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Eigen::Index nodes = x_m_.size() / 3;
  const Eigen::Matrix3Xd moved_m =
      (R * x_m_.reshaped(3, nodes)).colwise() + Eigen::Vector3d(0.3, -0.1, 0.2);
  const Eigen::Matrix3Xd force_N = Gradient(x_m_).reshaped(3, nodes);
  const Eigen::Matrix3Xd turned_N = Gradient(moved_m.reshaped()).reshaped(3, nodes);
  EXPECT_LT((turned_N - R * force_N).norm(), 1e-9 * force_N.norm());
  EXPECT_LT(force_N.rowwise().sum().norm(), 1e-9 * force_N.norm());
  Eigen::Vector3d moment_Nm = Eigen::Vector3d::Zero();
  for (Eigen::Index node = 0; node < nodes; ++node) {
    moment_Nm += x_m_.segment<3>(3 * node).cross(force_N.col(node));
  }
  EXPECT_LT(moment_Nm.norm(), 1e-9 * force_N.norm());
}

TEST_F(KeptStressLaw, OfNothingIsOff) {
  kept_.Set(points_, {});
  EXPECT_EQ(kept_.Command().mode, fem::ConstraintCommand::Mode::kOff);
  EXPECT_EQ(kept_.Value(x_m_), 0.0);
  EXPECT_EQ(Gradient(x_m_).norm(), 0.0);
}

}  // namespace
}  // namespace palpate::diagnosis
