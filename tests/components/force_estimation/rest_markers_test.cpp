// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/rest_markers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kTenthOfAMillimetre_m = 1e-4;

/// Markers of the beam and of the four-legged robot, some tens of millimetres apart.
class RestMarkersTest : public testing::TestWithParam<const char*> {
 protected:
  RestMarkersTest() {
    const robot::RobotDescription robot =
        std::string(GetParam()) == "beam" ? BeamRobot() : QuickFourLegRobot();
    const auto count = ToIndex(robot.markers.size());
    markers_.model_m.resize(3, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      markers_.names.push_back(robot.markers[At(k)].name);
      markers_.model_m.col(k) = robot.markers[At(k)].position_m;
    }
    std::mt19937 random(3);
    markers_.measured_m = markers_.model_m;
    for (auto column : markers_.measured_m.colwise()) {
      column += NormalNoise(3.0 * kTenthOfAMillimetre_m, random);
    }
  }

  void Move(const Eigen::Isometry3d& motion) {
    markers_.measured_m = motion * markers_.measured_m.colwise().homogeneous();
  }

  std::string Refusal(RestAgreement agreement) const {
    const Status status = CheckRestMarkers(markers_, agreement);
    EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
    return status.message();
  }

  RestMarkers markers_;
};

TEST_P(RestMarkersTest, AgreeWhereTheyAreTheRobots) {
  EXPECT_TRUE(CheckRestMarkers(markers_, RestAgreement::kShapeTurnAndPlace).ok());
}

TEST_P(RestMarkersTest, MayBeAnywhereWhereThePoseIsFree) {
  Move(Eigen::Translation3d(0.3, -2.0, 1.0) *
       Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()));
  EXPECT_TRUE(CheckRestMarkers(markers_, RestAgreement::kShape).ok());
}

TEST_P(RestMarkersTest, AreRefusedWhereTheyAreTurned) {
  Move(Eigen::Translation3d(0.0, 0.0, 0.3) *
       Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()));
  const auto says = AllOf(HasSubstr("turned by"), HasSubstr("90 degrees"), HasSubstr("--register"));
  EXPECT_THAT(Refusal(RestAgreement::kShapeAndTurn), says);
  EXPECT_THAT(Refusal(RestAgreement::kShapeTurnAndPlace), says);
}

TEST_P(RestMarkersTest, AreRefusedElsewhereOnlyWherePositionsCount) {
  Move(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.0)));
  EXPECT_TRUE(CheckRestMarkers(markers_, RestAgreement::kShapeAndTurn).ok());
  EXPECT_THAT(Refusal(RestAgreement::kShapeTurnAndPlace), HasSubstr("1 m"));
}

TEST_P(RestMarkersTest, ExchangedLabelsAreNamed) {
  const Eigen::Index last = markers_.measured_m.cols() - 1;
  markers_.measured_m.col(1).swap(markers_.measured_m.col(last));
  EXPECT_THAT(Refusal(RestAgreement::kShape),
              AllOf(HasSubstr("'" + markers_.names[1] + "'"),
                    HasSubstr("'" + markers_.names[At(last)] + "'"), HasSubstr("exchanged")));
}

TEST_P(RestMarkersTest, AnotherUnitIsRefused) {
  markers_.measured_m *= 10.0;
  EXPECT_THAT(Refusal(RestAgreement::kShape),
              AllOf(HasSubstr("10 times as far apart"), HasSubstr("unit")));
}

INSTANTIATE_TEST_SUITE_P(Robots, RestMarkersTest, testing::Values("beam", "four_leg"),
                         [](const auto& one) { return std::string(one.param); });

TEST(RestMarkers, TooFewMarkersAreNotCompared) {
  RestMarkers markers{.names = {"a", "b"},
                      .measured_m = Eigen::Matrix3Xd::Ones(3, 2),
                      .model_m = Eigen::Matrix3Xd::Zero(3, 2)};
  EXPECT_TRUE(CheckRestMarkers(markers, RestAgreement::kShapeTurnAndPlace).ok());
}

TEST(RestMarkers, OfTheModelAreUndeformedOrInEquilibrium) {
  const auto model = Build(BeamRobot());
  Eigen::VectorXd straight_m;
  Eigen::VectorXd hanging_m;
  ASSERT_TRUE(ReferenceMarkers(*model, ReferenceShape::kUndeformed, {}, &straight_m).ok());
  ASSERT_TRUE(ReferenceMarkers(*model, ReferenceShape::kEquilibrium, {}, &hanging_m).ok());
  const Eigen::Index last_z = straight_m.size() - 1;
  EXPECT_LT(hanging_m[last_z], straight_m[last_z] - 1e-3);
  model->SetGravity(Eigen::Vector3d::Zero());
  ASSERT_TRUE(ReferenceMarkers(*model, ReferenceShape::kEquilibrium, {}, &hanging_m).ok());
  EXPECT_LT((hanging_m - straight_m).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace palpate::force_estimation
