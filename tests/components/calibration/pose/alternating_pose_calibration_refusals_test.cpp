// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libs/geometry/rigid_registration.hpp"
#include "tests/components/calibration/table_one.hpp"

namespace palpate::calibration {
namespace {

using testing::HasSubstr;

class Algorithm1Refusals : public testing::Test {
 protected:
  Algorithm1Refusals() : Algorithm1Refusals(QuickFourLegRobot()) {}
  explicit Algorithm1Refusals(const robot::RobotDescription& robot)
      : model_(Build(robot)), truth_(SolveTensions(*model_, kTableOneForces_N)) {}

  std::vector<MarkerSighting> Seen(const std::vector<int>& markers = kNineMarkers,
                                   double sigma_m = 1e-4) const {
    return Sight(*model_, truth_, TableOnePose(), markers, sigma_m);
  }

  /// Refused for this reason, and no pose given.
  void ExpectRefusal(const std::vector<MarkerSighting>& sightings, PoseFinding finding,
                     const std::string& reason) {
    const PoseAndInputs found = RunAlgorithm1(*model_, sightings);
    EXPECT_EQ(ToString(found.finding), ToString(finding));
    EXPECT_FALSE(found.status.ok());
    EXPECT_THAT(found.status.message(), HasSubstr(reason));
    EXPECT_EQ(found.T_robot_camera.translation_m(), Eigen::Vector3d::Zero());
    EXPECT_EQ(found.lambda_a_N, Eigen::VectorXd::Zero(4));
  }

  std::unique_ptr<robot::RobotModel> model_;
  fem::StaticState truth_;
};

TEST_F(Algorithm1Refusals, WhatIsNoSighting) {
  std::vector<MarkerSighting> sightings = Seen();
  sightings[3].position_m.y() = std::numeric_limits<double>::quiet_NaN();
  ExpectRefusal(sightings, PoseFinding::kInvalidInput, "marker 3: a coordinate is not finite");
  sightings = Seen();
  sightings[3].covariance_m2(1, 1) = 0.0;
  ExpectRefusal(sightings, PoseFinding::kInvalidInput, "marker 3: the covariance");
  sightings = Seen();
  sightings[3].marker = 7;
  ExpectRefusal(sightings, PoseFinding::kInvalidInput, "marker 7 is sighted twice");
  sightings[3].marker = 9;
  ExpectRefusal(sightings, PoseFinding::kInvalidInput, "marker 9 is not one of the robot's 9");
}

TEST_F(Algorithm1Refusals, TooFewMarkers) {
  ExpectRefusal(Seen({0, 5}), PoseFinding::kDegenerateMarkers, "needs 3 markers, there are 2");
  ExpectRefusal({}, PoseFinding::kDegenerateMarkers, "there are 0");
}

TEST_F(Algorithm1Refusals, MarkersInOnePlaceOrOnOneLine) {
  std::vector<MarkerSighting> sightings = Seen();
  for (MarkerSighting& sighting : sightings) sighting.position_m = {0.1, 0.2, 0.3};
  ExpectRefusal(sightings, PoseFinding::kDegenerateMarkers, "one place");
  for (size_t k = 0; k < sightings.size(); ++k) {
    sightings[k].position_m.x() = 0.01 * static_cast<double>(k);
  }
  ExpectRefusal(sightings, PoseFinding::kDegenerateMarkers, "one line");
}

/// Three markers have no coordinate left for four inputs.
TEST_F(Algorithm1Refusals, FewerCoordinatesThanUnknowns) {
  ExpectRefusal(Seen({0, 5, 6}), PoseFinding::kUnknownInputs, "cable");
}

TEST_F(Algorithm1Refusals, MirroredMarkers) {
  std::vector<MarkerSighting> sightings = Seen();
  for (MarkerSighting& sighting : sightings) sighting.position_m.x() *= -1.0;
  ExpectRefusal(sightings, PoseFinding::kMirroredMarkers, "mirrored");
}

/// East and west swapped, as by one who looks at the robot from the wrong side.
TEST_F(Algorithm1Refusals, MarkersAssignedTheWrongWayRound) {
  const std::vector<int> swapped = {0, 2, 1, 4, 3, 5, 8, 7, 6};
  std::vector<MarkerSighting> sightings = Seen();
  for (MarkerSighting& sighting : sightings) {
    sighting.marker = swapped[static_cast<size_t>(sighting.marker)];
  }
  ExpectRefusal(sightings, PoseFinding::kMirroredMarkers, "mirrored");
}

/// Four in a plane: a reflection is no better for them than a turn until the cables deform it.
TEST_F(Algorithm1Refusals, MirroredMarkersThatOnlyTheirDeformationTells) {
  truth_ = SolveTensions(*model_, Eigen::Vector4d(4.0, 0.0, 0.0, 0.0));
  std::vector<MarkerSighting> sightings = Seen({5, 6, 7, 8});
  for (MarkerSighting& sighting : sightings) sighting.position_m.x() *= -1.0;
  ExpectRefusal(sightings, PoseFinding::kMirroredMarkers, "a reflection fits them");
}

TEST_F(Algorithm1Refusals, AnotherRobotWhichIsLarger) {
  std::vector<MarkerSighting> sightings = Seen();
  for (MarkerSighting& sighting : sightings) sighting.position_m *= 1.1;
  ExpectRefusal(sightings, PoseFinding::kWrongRobot, "the sizes disagree: markers are ");
}

TEST_F(Algorithm1Refusals, AMarkerTakenForSomethingElse) {
  std::vector<MarkerSighting> sightings = Seen();
  sightings[6].position_m += Eigen::Vector3d(0.004, -0.003, 0.004);
  ExpectRefusal(sightings, PoseFinding::kWrongRobot, "assigned wrongly");
}

/// They ask for forces under which there is no equilibrium.
TEST_F(Algorithm1Refusals, TwoMarkersTakenForEachOther) {
  std::vector<MarkerSighting> sightings = Seen();
  std::swap(sightings[1].marker, sightings[6].marker);
  ExpectRefusal(sightings, PoseFinding::kFailedEquilibrium, "no equilibrium under the inputs");
}

/// Those of the hub move with it nearly as one body.
TEST_F(Algorithm1Refusals, MarkersThatMoveAsOneBody) {
  ExpectRefusal(Seen({0, 1, 2, 3, 4}, 5e-4), PoseFinding::kUnknownInputs,
                "do not distinguish from a camera motion");
}

TEST_F(Algorithm1Refusals, LimitsThatCross) {
  Algorithm1Settings settings;
  settings.limits.resize(4);
  settings.limits[2] = {.least_displacement_m = 0.02, .most_displacement_m = 0.01};
  const PoseAndInputs found = RunAlgorithm1(*model_, Seen(), settings);
  EXPECT_EQ(found.finding, PoseFinding::kInvalidInput);
  EXPECT_THAT(found.status.message(), HasSubstr("cross"));
}

TEST_F(Algorithm1Refusals, NoEquilibriumToStartFrom) {
  const std::vector<MarkerSighting> sightings = Seen();
  model_->SetGravity({0.0, 0.0, -9810.0});
  ExpectRefusal(sightings, PoseFinding::kFailedEquilibrium, "no equilibrium to start from");
}

TEST_F(Algorithm1Refusals, IterationsUsedUp) {
  const std::vector<MarkerSighting> sightings = Seen();
  const PoseAndInputs found = RunAlgorithm1(*model_, sightings, {.max_outer_iterations = 20});
  EXPECT_EQ(found.finding, PoseFinding::kNotConverged);
  EXPECT_THAT(found.status.message(), HasSubstr("20 iterations used up"));
  // What is left to come is known.
  const double missing_N = (found.lambda_a_N - kTableOneForces_N).lpNorm<Eigen::Infinity>();
  EXPECT_GT(found.remaining_change_N, 0.3 * missing_N);
  EXPECT_LT(found.remaining_change_N, 3.0 * missing_N);
  // The pose is the best for the inputs.
  Eigen::Matrix3Xd camera_m(3, 9), model_m(3, 9);
  for (Eigen::Index k = 0; k < 9; ++k) {
    const auto& weights = model_->body().markers[static_cast<size_t>(k)].point.weights;
    camera_m.col(k) = sightings[static_cast<size_t>(k)].position_m;
    model_m.col(k) = weights.Position(found.state.x_m);
  }
  const geometry::Registration pose = geometry::RegisterRigid(camera_m, model_m);
  EXPECT_LT((pose.T_target_source.translation_m() - found.T_robot_camera.translation_m()).norm(),
            1e-9);
  EXPECT_NEAR(pose.rms_m, found.residual_rms_m, 1e-12);
}

/// No cable pulls: the inputs are estimated as zero, and the pose is estimated.
TEST_F(Algorithm1Refusals, ZeroMotionIsSaid) {
  const fem::StaticState rest = SolveTensions(*model_, Eigen::VectorXd::Zero(4));
  std::vector<MarkerSighting> sightings = Sight(*model_, rest, TableOnePose(), kNineMarkers);
  std::mt19937 random(31);
  std::normal_distribution<double> noise(0.0, 1e-4);
  for (MarkerSighting& sighting : sightings) {
    sighting.position_m += Eigen::Vector3d::NullaryExpr([&] { return noise(random); });
  }
  const PoseAndInputs found = RunAlgorithm1(*model_, sightings);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_EQ(found.finding, PoseFinding::kZeroMotion);
  EXPECT_LT((found.T_robot_camera.translation_m() - TableOnePose().translation_m()).norm(), 2e-3);
}

/// The soles are glued to the plate.
class MarkersOnTheFixedPart : public Algorithm1Refusals {
 protected:
  static robot::RobotDescription Robot() {
    robot::RobotDescription robot = QuickFourLegRobot();
    robot.markers = {{"north", {0.0, 0.09, 0.0}, {}},
                     {"west", {-0.09, 0.0, 0.0}, {}},
                     {"south", {0.0, -0.09, 0.0}, {}},
                     {"east", {0.09, 0.0, 0.0}, {}}};
    return robot;
  }
  MarkersOnTheFixedPart() : Algorithm1Refusals(Robot()) {}
};

TEST_F(MarkersOnTheFixedPart, TellNoInput) {
  ExpectRefusal(Seen({0, 1, 2, 3}), PoseFinding::kUnknownInputs,
                "no marker moves with the input of cable north, cable west, cable south");
}

/// Limits are kept, exactly: of displacement in the solved equilibrium, too.
TEST_F(Algorithm1Refusals, OmegaIsKept) {
  const double north_m = model_->StateOfActuator(0, truth_).displacement_m;
  Algorithm1Settings settings;
  settings.limits.resize(4);
  settings.limits[0].most_displacement_m = north_m - 3e-4;
  settings.limits[3].most_tension_N = 1.1;
  const PoseAndInputs found = RunAlgorithm1(*model_, Seen(kNineMarkers, 1e-3), settings);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_NEAR(found.displacement_m[0], north_m - 3e-4, 1e-9);
  EXPECT_NEAR(found.lambda_a_N[3], 1.1, 1e-9);
  EXPECT_GT(found.lambda_a_N[1], 0.1);
}

}  // namespace
}  // namespace palpate::calibration
