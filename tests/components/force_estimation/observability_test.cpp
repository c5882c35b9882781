// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kTip(0.0, 0.015, 0.03);
constexpr char kObservedSite[] = "tip: 0, 0.015, 0.03, 0.005";
const Eigen::Vector3d kForce_N(0.1, -0.2, -0.4);

MarkerFrame TipForceFrame(robot::RobotModel& model) {
  return FrameUnder(model, {}, {LoadAt(model, kTip, 0.005, kForce_N)});
}

TEST(Observability, ForceAtTheClampIsUnknownNotZero) {
  const auto model = Build(BeamRobot());
  const MarkerFrame frame = TipForceFrame(*model);
  MarkerForceEstimator alone(*model, WithContacts({"clamp: -0.1, 0.015, 0.015"}));
  const ForceEstimate& estimate = alone.Update(frame);
  EXPECT_EQ(estimate.status.code(), StatusCode::kUnobservable);
  ASSERT_EQ(estimate.contacts.size(), 1U);
  EXPECT_EQ(estimate.contacts[0].name, "clamp");
  EXPECT_EQ(estimate.contacts[0].status.code(), StatusCode::kUnobservable);
  EXPECT_TRUE(estimate.contacts[0].force_N.array().isNaN().all());
  EXPECT_TRUE(std::isnan(estimate.contacts[0].ci95_N));
  EXPECT_TRUE(estimate.contacts[0].covariance_N2.array().isNaN().all());
}

TEST(Observability, ForceAtTheClampDoesNotSpoilTheOthers) {
  const auto model = Build(BeamRobot());
  MarkerForceEstimator estimator(*model,
                                 WithContacts({"clamp: -0.1, 0.015, 0.015", kObservedSite}));
  const ForceEstimate& estimate = estimator.Update(TipForceFrame(*model));
  ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
  EXPECT_EQ(estimate.contacts[0].status.code(), StatusCode::kUnobservable);
  EXPECT_TRUE(estimate.contacts[0].force_N.array().isNaN().all());
  EXPECT_TRUE(estimate.contacts[1].status.ok());
  EXPECT_LT((estimate.contacts[1].force_N - kForce_N).norm(), 1e-6);
}

TEST(Observability, NoContactBesideAnUnknownForceIsNotNoContact) {
  const auto model = Build(BeamRobot());
  MarkerForceEstimator estimator(*model,
                                 WithContacts({"clamp: -0.1, 0.015, 0.015", kObservedSite}));
  const ForceEstimate& estimate = estimator.Update(FrameUnder(*model, {}, {}));
  EXPECT_EQ(estimate.status.code(), StatusCode::kUnobservable);
  ASSERT_EQ(estimate.contacts.size(), 2U);
  EXPECT_EQ(estimate.contacts[1].status.code(), StatusCode::kNoContact);
}

TEST(Observability, GivenDirectionAtTheClampIsUnknown) {
  const auto model = Build(BeamRobot());
  MarkerForceEstimator estimator(*model,
                                 WithContacts({"clamp: -0.1, 0.015, 0.015 along 0, 0, -1"}));
  const ForceEstimate& estimate = estimator.Update(TipForceFrame(*model));
  EXPECT_EQ(estimate.contacts[0].status.code(), StatusCode::kUnobservable);
  EXPECT_TRUE(estimate.contacts[0].force_N.array().isNaN().all());
}

TEST(Observability, OneMarkerDoesNotTellTwoForces) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = TipForceFrame(*model);
  for (size_t m = 0; m + 1 < frame.markers.size(); ++m) frame.markers[m].valid = false;
  MarkerForceEstimator estimator(*model, WithContacts({kObservedSite, "middle: -0.05, 0, 0.015"}));
  const ForceEstimate& estimate = estimator.Update(frame);
  EXPECT_EQ(estimate.status.code(), StatusCode::kUnobservable);
  ASSERT_EQ(estimate.contacts.size(), 2U);
  EXPECT_EQ(estimate.contacts[1].name, "middle");
  for (const ContactForce& contact : estimate.contacts) {
    EXPECT_EQ(contact.status.code(), StatusCode::kUnobservable) << contact.name;
    EXPECT_TRUE(contact.force_N.array().isNaN().all()) << contact.name;
  }
}

TEST(Observability, SaysWhereOnlyTheNormalForceIsKnown) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d middle(-0.06, 0.015, 0.03);
  const MarkerFrame frame =
      FrameUnder(*model, {}, {LoadAt(*model, middle, 0.005, {0.0, 0.0, -0.5})});
  Config config = WithContacts({"middle: -0.06, 0.015, 0.03, 0.005"});
  MarkerForceEstimator everything(*model, config);
  const ContactForce full = everything.Update(frame).contacts[0];
  ASSERT_TRUE(full.status.ok());
  // The force along the beam is the least certain; a limit just below its sigma leaves it out.
  const double along_beam_N = std::sqrt(full.covariance_N2(0, 0));
  ASSERT_GT(along_beam_N, 2.0 * std::sqrt(full.covariance_N2(2, 2)));
  config.unobservable_sigma_N = 0.9 * along_beam_N;
  // As much friction as push would bend the beam as a smaller push does.
  MarkerForceEstimator with_friction(*model, config);
  EXPECT_EQ(with_friction.Update(frame).contacts[0].status.code(), StatusCode::kUncertain);
  config.friction_sigma = 0.1;
  MarkerForceEstimator estimator(*model, config);
  const ForceEstimate& estimate = estimator.Update(frame);
  EXPECT_TRUE(estimate.status.ok());
  EXPECT_EQ(estimate.contacts[0].status.code(), StatusCode::kTangentialUnobservable);
  EXPECT_LT((estimate.contacts[0].force_N - Eigen::Vector3d(0.0, 0.0, -0.5)).norm(), 1e-6);
  EXPECT_EQ(estimate.degrees_of_freedom, 36 - 2);
}

TEST(Observability, MissingAndNanMarkersAreLeftOut) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = TipForceFrame(*model);
  frame.markers[0].position_m.y() = kNaN;
  frame.markers[5].valid = false;
  frame.markers[5].position_m.setConstant(1.0);
  MarkerForceEstimator estimator(*model, WithContacts({kObservedSite}));
  const ForceEstimate& estimate = estimator.Update(frame);
  ASSERT_TRUE(estimate.status.ok());
  EXPECT_LT((estimate.contacts[0].force_N - kForce_N).norm(), 1e-6);
  EXPECT_EQ(estimate.degrees_of_freedom, 27 - 3);  // one more stands on the contact
  EXPECT_EQ(estimate.marker_residual_m.head<3>(), Eigen::Vector3d::Zero());
}

TEST(Observability, MarkersOnAContactCountByTheirWeight) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = TipForceFrame(*model);
  frame.markers[9].position_m.z() += 0.001;  // stands where the force acts
  Config config = WithContacts({kObservedSite});
  config.contact_marker_weight = 0.0;
  MarkerForceEstimator estimator(*model, config);
  const ForceEstimate& estimate = estimator.Update(frame);
  EXPECT_LT((estimate.contacts[0].force_N - kForce_N).norm(), 1e-6);
  EXPECT_EQ(estimate.degrees_of_freedom, 33 - 3);
  EXPECT_LT(estimate.chi_squared, 1e-6);
  config.contact_marker_weight = 1.0;
  MarkerForceEstimator trusting(*model, config);
  const ForceEstimate& spoilt = trusting.Update(frame);
  EXPECT_GT((spoilt.contacts[0].force_N - kForce_N).norm(), 1e-4);
  EXPECT_EQ(spoilt.degrees_of_freedom, 36 - 3);
}

TEST(Observability, WithoutAnyMarkerNothingIsEstimated) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = TipForceFrame(*model);
  MarkerForceEstimator estimator(*model, WithContacts({kObservedSite}));
  ASSERT_TRUE(estimator.Update(frame).status.ok());
  for (MarkerObservation& marker : frame.markers) marker.valid = false;
  const ForceEstimate& estimate = estimator.Update(frame);
  EXPECT_EQ(estimate.status.code(), StatusCode::kNoRobotSeen);
  // Nothing of the frame before stands for this one.
  EXPECT_TRUE(estimate.contacts.empty());
  EXPECT_TRUE(std::isnan(estimate.chi_squared));
  EXPECT_TRUE(std::isnan(estimate.residual_rms_m));
  EXPECT_TRUE(estimate.x_m.array().isNaN().all());
}

TEST(Observability, NanCommandIsRefused) {
  const auto model = Build(QuickFourLegRobot());
  std::vector<robot::ActuatorCommand> cables(4, {Kind::kTension, 1.0});
  MarkerFrame frame = FrameUnder(*model, cables, {});
  frame.cables[2].value = kNaN;
  MarkerForceEstimator estimator(*model, WithContacts({"hub: 0, 0, 0.125, 0.008"}));
  const ForceEstimate& estimate = estimator.Update(frame);
  EXPECT_EQ(estimate.status.code(), StatusCode::kInvalidInput);
  EXPECT_TRUE(estimate.contacts.empty());
  frame.cables[2].value = 1.0;
  EXPECT_EQ(estimator.Update(frame).status.code(), StatusCode::kNoContact);
}

TEST(Observability, CableBeyondItsLimitIsRefusedInAnyFrame) {
  const auto model = Build(QuickFourLegRobot());
  const std::vector<robot::ActuatorCommand> cables(4, {Kind::kTension, 1.0});
  const MarkerFrame good = FrameUnder(*model, cables, {});
  MarkerFrame bad = good;
  bad.cables[1].value = 20.5;  // max_tension_N: 20
  MarkerForceEstimator estimator(*model, WithContacts({"hub: 0, 0, 0.125, 0.008"}));
  EXPECT_EQ(estimator.Update(bad).status.code(), StatusCode::kTensionLimit);
  EXPECT_EQ(estimator.Update(good).status.code(), StatusCode::kNoContact);
  const ForceEstimate& estimate = estimator.Update(bad);
  EXPECT_EQ(estimate.status.code(), StatusCode::kTensionLimit);
  EXPECT_NE(estimate.status.message().find("cable west"), std::string::npos);
  bad.cables[1].value = -1.0;
  EXPECT_EQ(estimator.Update(bad).status.code(), StatusCode::kTensionLimit);
}

}  // namespace
}  // namespace palpate::force_estimation
