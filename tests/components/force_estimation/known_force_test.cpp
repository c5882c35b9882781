// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/core/error.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kKnownTip(0.0, 0.015, 0.03);
constexpr char kTipSite[] = "tip: 0, 0.015, 0.03, 0.005";
const Eigen::Vector3d kKnownHub(0.0, 0.0, 0.125);
constexpr char kHubSite[] = "hub: 0, 0, 0.125, 0.008";

/// How the four cables of four_leg are driven.
struct Drive {
  std::string name;
  std::vector<robot::ActuatorCommand> cables;
};

class DrivenBody : public testing::TestWithParam<Drive> {};

TEST_P(DrivenBody, RecoversAForceInThreeDirections) {
  const auto model = Build(QuickFourLegRobot());
  const Eigen::Vector3d force_N(0.3, -0.2, -0.9);
  const MarkerFrame frame =
      FrameUnder(*model, GetParam().cables, {LoadAt(*model, kKnownHub, 0.008, force_N)});
  MarkerForceEstimator estimator(*model, WithContacts({kHubSite}));
  const ForceEstimate& estimate = estimator.Update(frame);
  ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
  ASSERT_TRUE(estimate.contacts[0].status.ok());
  EXPECT_LT((estimate.contacts[0].force_N - force_N).norm(), 1e-6);
  EXPECT_LT(estimate.residual_rms_m, 1e-9);
}

TEST_P(DrivenBody, ReportsTheCablesAsTheyAre) {
  const auto model = Build(QuickFourLegRobot());
  const auto load = LoadAt(*model, kKnownHub, 0.008, {0.3, -0.2, -0.9});
  const fem::StaticState truth = SolveTruth(*model, GetParam().cables, {load});
  MarkerForceEstimator estimator(*model, WithContacts({kHubSite}));
  const ForceEstimate& estimate = estimator.Update(FrameOf(*model, truth, GetParam().cables));
  for (int c = 0; c < model->ActuatorCount(); ++c) {
    const robot::ActuatorState expected = model->StateOfActuator(c, truth);
    const robot::ActuatorState& found = estimate.cables[static_cast<size_t>(c)];
    EXPECT_NEAR(found.tension_N, expected.tension_N, 1e-6) << c;
    EXPECT_NEAR(found.displacement_m, expected.displacement_m, 1e-9) << c;
    EXPECT_NEAR(found.length_m, expected.length_m, 1e-9) << c;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cables, DrivenBody,
    testing::Values(
        Drive{"Off", {{}, {}, {}, {}}},
        Drive{"Displacement",
              {{Kind::kDisplacement, 0.006},
               {Kind::kDisplacement, 0.004},
               {Kind::kDisplacement, 0.002},
               {Kind::kDisplacement, 0.003}}},
        Drive{"Tension", {{Kind::kTension, 1.5}, {Kind::kTension, 0.0}, {Kind::kTension, 1.0}, {}}},
        Drive{"SlackAndTaut",
              {{Kind::kDisplacement, 0.006},
               {Kind::kDisplacement, -0.01},
               {Kind::kTension, 0.8},
               {Kind::kDisplacement, -0.02}}}),
    [](const auto& one) { return one.param.name; });

TEST(MarkerForceEstimator, ReportsNoContactAtRest) {
  const auto model = Build(BeamRobot());
  const MarkerFrame frame = FrameUnder(*model, {}, {});
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite, "side: -0.05, 0, 0.015"}));
  const ForceEstimate& estimate = estimator.Update(frame);
  EXPECT_EQ(estimate.status.code(), StatusCode::kNoContact);
  for (const ContactForce& contact : estimate.contacts) {
    EXPECT_EQ(contact.status.code(), StatusCode::kNoContact) << contact.name;
    EXPECT_LT(contact.force_N.norm(), 1e-6);
    EXPECT_GT(contact.ci95_N, 1e-4);
  }
}

TEST(MarkerForceEstimator, RecoversTwoForcesAtOnce) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d middle(-0.05, 0.0, 0.015);
  const Eigen::Vector3d at_tip_N(0.1, -0.05, -0.3);
  const Eigen::Vector3d at_middle_N(-0.2, 0.6, 0.1);
  const MarkerFrame frame = FrameUnder(
      *model, {},
      {LoadAt(*model, kKnownTip, 0.005, at_tip_N), LoadAt(*model, middle, 0.004, at_middle_N)});
  MarkerForceEstimator estimator(*model,
                                 WithContacts({kTipSite, "middle: -0.05, 0, 0.015, 0.004"}));
  const ForceEstimate& estimate = estimator.Update(frame);
  ASSERT_TRUE(estimate.status.ok());
  EXPECT_LT((estimate.contacts[0].force_N - at_tip_N).norm(), 1e-6);
  EXPECT_LT((estimate.contacts[1].force_N - at_middle_N).norm(), 1e-6);
}

TEST(MarkerForceEstimator, FollowsALargeDeformationFromAColdStart) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d force_N(0.4, -0.8, -2.0);
  const fem::StaticState truth =
      SolveTruth(*model, {}, {LoadAt(*model, kKnownTip, 0.005, force_N)});
  const fem::InterpolationWeights tip = model->Patch(kKnownTip, 0.005).weights;
  ASSERT_GT((tip.Position(truth.x_m) - kKnownTip).norm(), 0.02);
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite}));
  const ForceEstimate& estimate = estimator.Update(FrameOf(*model, truth, {}));
  ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
  EXPECT_LT((estimate.contacts[0].force_N - force_N).norm(), 1e-6);
  EXPECT_LT((estimate.contacts[0].position_m - tip.Position(truth.x_m)).norm(), 1e-8);
  EXPECT_LT((estimate.x_m - truth.x_m).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(MarkerForceEstimator, FitsOnlyTheSizeOfAForceWhoseDirectionIsGiven) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d direction = Eigen::Vector3d(0.0, 1.0, -2.0).normalized();
  const MarkerFrame frame =
      FrameUnder(*model, {}, {LoadAt(*model, kKnownTip, 0.005, 0.4 * direction)});
  MarkerForceEstimator estimator(*model, WithContacts({std::string(kTipSite) + " along 0, 1, -2"}));
  const ContactForce& contact = estimator.Update(frame).contacts[0];
  EXPECT_TRUE(contact.status.ok());
  EXPECT_LT((contact.force_N - 0.4 * direction).norm(), 1e-6);
  // The covariance has no part across the direction.
  EXPECT_NEAR(contact.covariance_N2.trace(), direction.dot(contact.covariance_N2 * direction),
              1e-9 * contact.covariance_N2.trace());

  const MarkerFrame at_rest = FrameUnder(*model, {}, {});
  const ContactForce& nothing = estimator.Update(at_rest).contacts[0];
  EXPECT_EQ(nothing.status.code(), StatusCode::kNoContact);
  EXPECT_GT(nothing.ci95_N, 1e-5);
}

TEST(MarkerForceEstimator, ForgetsTheFrameBefore) {
  const auto model = Build(QuickFourLegRobot());
  const std::vector<robot::ActuatorCommand> first_cables(4, {Kind::kDisplacement, 0.002});
  const std::vector<robot::ActuatorCommand> cables = {{Kind::kDisplacement, 0.006},
                                                      {Kind::kDisplacement, -0.01},
                                                      {Kind::kTension, 1.0},
                                                      {Kind::kDisplacement, 0.003}};
  const MarkerFrame first =
      FrameUnder(*model, first_cables, {LoadAt(*model, kKnownHub, 0.008, {0.5, 0.4, -1.5})});
  MarkerFrame frame =
      FrameUnder(*model, cables, {LoadAt(*model, kKnownHub, 0.008, {-0.3, 0.1, -0.4})});
  std::mt19937 random(7);
  AddNoise(1e-4, random, &frame);
  MarkerForceEstimator warm(*model, WithContacts({kHubSite}));
  ASSERT_TRUE(warm.Update(first).status.ok());
  const ContactForce from_warm = warm.Update(frame).contacts[0];
  MarkerForceEstimator cold(*model, WithContacts({kHubSite}));
  const ContactForce from_cold = cold.Update(frame).contacts[0];
  EXPECT_LT((from_warm.force_N - from_cold.force_N).norm(), 1e-8);
  EXPECT_NEAR(from_warm.ci95_N, from_cold.ci95_N, 1e-8);
}

/// The box that holds the rotated box; exact for turns by right angles.
geometry::Box Rotated(const Eigen::Matrix3d& R, const geometry::Box& box) {
  Eigen::Matrix3Xd corners_m(3, 2);
  corners_m << R * box.lower_m, R * box.upper_m;
  return geometry::BoundingBox(corners_m);
}

TEST(MarkerForceEstimator, TurnsWithTheFrame) {
  const robot::RobotDescription robot = BeamRobot();
  Eigen::Matrix3d R;
  R << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  robot::RobotDescription turned = robot;
  turned.mesh.rotate_xyz_deg.z() += 90.0;
  turned.mesh.translate_m = R * robot.mesh.translate_m;
  turned.gravity_m_s2 = R * Eigen::Vector3d(0.0, 4.0, -9.0);
  for (geometry::Box& box : turned.fixed) box = Rotated(R, box);
  for (robot::MarkerSettings& marker : turned.markers) marker.position_m = R * marker.position_m;
  const auto model = Build(robot);
  model->SetGravity({0.0, 4.0, -9.0});
  const auto turned_model = Build(turned);

  MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, kKnownTip, 0.005, {0.1, -0.2, -0.4})});
  std::mt19937 random(3);
  AddNoise(1e-4, random, &frame);
  MarkerFrame turned_frame = frame;
  for (MarkerObservation& marker : turned_frame.markers) marker.position_m = R * marker.position_m;
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite}));
  MarkerForceEstimator turned_estimator(*turned_model,
                                        WithContacts({"tip: -0.015, 0, 0.03, 0.005"}));
  const ContactForce& plain = estimator.Update(frame).contacts[0];
  const ContactForce& result = turned_estimator.Update(turned_frame).contacts[0];
  EXPECT_LT((result.force_N - R * plain.force_N).norm(), 1e-7);
  EXPECT_LT((result.position_m - R * plain.position_m).norm(), 1e-8);
  EXPECT_LT((result.covariance_N2 - R * plain.covariance_N2 * R.transpose()).norm(),
            1e-6 * plain.covariance_N2.norm());
}

TEST(MarkerForceEstimator, RefusesWhatItCannotFit) {
  const auto refusal = [](const robot::RobotDescription& robot, const Config& config) {
    const auto model = Build(robot);
    try {
      MarkerForceEstimator estimator(*model, config);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was refused");
  };
  EXPECT_THAT(refusal(BeamRobot(), WithContacts({"far: 0.5, 0, 0"})),
              testing::HasSubstr("contact 'far' lies"));
  std::vector<std::string> many;
  for (int i = 0; i < 6; ++i) many.push_back("c" + std::to_string(i) + ": 0, 0.015, 0.03");
  EXPECT_THAT(refusal(BeamRobot(), WithContacts(many)),
              testing::HasSubstr("6 are given; at most 5"));
  robot::RobotDescription bare = BeamRobot();
  bare.markers.clear();
  EXPECT_THAT(refusal(bare, WithContacts({kTipSite})), testing::HasSubstr("no markers"));
}

}  // namespace
}  // namespace palpate::force_estimation
