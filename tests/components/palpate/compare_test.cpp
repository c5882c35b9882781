// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "components/palpate/compare/comparison_summary.hpp"
#include "components/palpate/compare/force_tracks.hpp"
#include "components/palpate/compare/live_line.hpp"

namespace palpate::command {
namespace {

using force_estimation::ContactForce;
using force_estimation::ForceEstimate;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

const Eigen::Vector3d kHub_m(0.02, 0.0, 0.1);
const Eigen::Vector3d kLeg_m(0.02, 0.09, 0.1);

TrueContact True(const std::string& name, const Eigen::Vector3d& position_m, double pushed_N) {
  return {name, position_m, {0.0, 0.0, -pushed_N}};
}

ContactForce Found(const Eigen::Vector3d& position_m, double pushed_N, double ci95_N = 0.1,
                   StatusCode code = StatusCode::kOk) {
  ContactForce contact;
  contact.name = "contact_1";
  contact.status = Status(code, "");
  contact.position_m = position_m;
  contact.force_N = {0.0, 0.0, -pushed_N};
  contact.ci95_N = ci95_N;
  return contact;
}

ForceEstimate Frame(double t_s, std::vector<ContactForce> contacts) {
  ForceEstimate estimate;
  estimate.t_s = t_s;
  estimate.status = contacts.empty() ? Status(StatusCode::kNoContact, "") : Status::Ok();
  estimate.contacts = std::move(contacts);
  return estimate;
}

// One second, 20 samples, in which the same forces act.
TruthTimeline Constant(const std::vector<TrueContact>& contacts) {
  TruthTimeline truth;
  for (int i = 0; i <= 20; ++i) truth.Add(0.05 * i, contacts);
  return truth;
}

TEST(TruthTimeline, IsLinearBetweenItsSamplesAndUnknownBeyond) {
  TruthTimeline truth;
  truth.Add(1.0, {True("ball", {0.0, 0.0, 0.0}, 1.0)});
  truth.Add(1.1, {True("ball", {0.01, 0.0, 0.0}, 2.0), True("late", kLeg_m, 0.4)});
  truth.Add(1.05, {});  // comes too late to count
  truth.Add(1.9, {});
  EXPECT_FALSE(truth.At(0.99));
  EXPECT_FALSE(truth.At(1.91));
  EXPECT_FALSE(truth.At(1.3));               // too far from both neighbours
  EXPECT_THAT(*truth.At(1.104), SizeIs(2));  // a sample of that time, whatever follows
  EXPECT_THAT(*truth.At(1.904), SizeIs(0));
  ASSERT_TRUE(truth.At(1.025));
  ASSERT_THAT(*truth.At(1.025), SizeIs(1));
  EXPECT_NEAR((*truth.At(1.025))[0].force_N.z(), -1.25, 1e-9);
  EXPECT_NEAR((*truth.At(1.025))[0].position_m.x(), 0.0025, 1e-9);
  EXPECT_THAT(*truth.At(1.075), SizeIs(2));
  EXPECT_THAT(*truth.At(1.1), SizeIs(2));
}

TEST(TruthTimeline, IsSteadyWhereTheForceStays) {
  TruthTimeline truth;
  for (int i = 0; i <= 40; ++i) {
    const double t_s = 0.05 * i;
    truth.Add(t_s, {True("ball", kHub_m, std::min(1.0, t_s))});
  }
  EXPECT_FALSE(truth.IsSteady("ball", 0.8, 0.3, 0.05));
  EXPECT_FALSE(truth.IsSteady("ball", 1.1, 0.3, 0.05));
  EXPECT_TRUE(truth.IsSteady("ball", 1.31, 0.3, 0.05));
  EXPECT_TRUE(truth.IsSteady("ball", 1.28, 0.3, 0.05));  // 2 % is within the share
  EXPECT_FALSE(truth.IsSteady("other", 1.5, 0.3, 0.05));
  EXPECT_FALSE(truth.IsSteady("ball", 2.2, 0.3, 0.05));  // unknown
}

TEST(CompareFrame, GivesEachTrueForceTheNearestEstimate) {
  const TruthTimeline truth = Constant({True("a", kHub_m, 0.5), True("b", kLeg_m, 0.8)});
  const Eigen::Vector3d near_m(0.004, 0.0, 0.0);
  const auto compared = CompareFrame(
      Frame(0.7, {Found(kLeg_m + near_m, 0.9), Found(kHub_m - near_m, 0.4)}), truth, {});
  ASSERT_THAT(compared, SizeIs(2));
  EXPECT_EQ(compared[0].truth->name, "a");
  EXPECT_NEAR(ForceError_N(compared[0]), -0.1, 1e-9);
  EXPECT_NEAR(ForceError_N(compared[1]), 0.1, 1e-9);
  EXPECT_EQ(compared[0].true_forces, 2);
  EXPECT_TRUE(compared[0].due);
}

TEST(CompareFrame, ANearPairIsNotTornApartByAFarOne) {
  // Both estimates are nearest to the hub; the nearer one has it, the other goes without.
  const TruthTimeline truth = Constant({True("a", kHub_m, 0.5)});
  const auto compared =
      CompareFrame(Frame(0.7, {Found(kHub_m + Eigen::Vector3d(0.02, 0, 0), 0.1),
                               Found(kHub_m + Eigen::Vector3d(0.001, 0, 0), 0.5)}),
                   truth, {});
  ASSERT_THAT(compared, SizeIs(2));
  EXPECT_NEAR(ForceError_N(compared[0]), 0.0, 1e-9);
  EXPECT_FALSE(compared[1].truth);
}

TEST(CompareFrame, TellsMissesAndFalseAlarms) {
  const TruthTimeline truth = Constant({True("a", kHub_m, 0.5), True("tiny", kLeg_m, 0.02)});
  const auto nothing = CompareFrame(Frame(0.7, {}), truth, {});
  ASSERT_THAT(nothing, SizeIs(2));
  EXPECT_TRUE(nothing[0].due);
  EXPECT_FALSE(nothing[0].estimate);
  EXPECT_FALSE(nothing[1].due);  // too small to have to be found
  EXPECT_EQ(nothing[0].true_forces, 1);
  EXPECT_FALSE(CompareFrame(Frame(0.1, {}), truth, {})[0].due);  // not yet steady
  const auto far = CompareFrame(Frame(0.7, {Found({-0.05, 0.0, 0.1}, 0.3)}), truth, {});
  ASSERT_THAT(far, SizeIs(3));
  EXPECT_FALSE(far[2].truth);
  // A small force is found where it acts: that is no false alarm.
  EXPECT_THAT(CompareFrame(Frame(0.7, {Found(kLeg_m, 0.03)}), truth, {}), SizeIs(2));
}

TEST(CompareFrame, LeavesOutWhatHasNoResultAndForcesWithoutANumber) {
  const TruthTimeline truth = Constant({True("a", kHub_m, 0.5)});
  ForceEstimate unseen = Frame(0.7, {});
  unseen.status = Status(StatusCode::kNoRobotSeen, "");
  EXPECT_THAT(CompareFrame(unseen, truth, {}), SizeIs(0));
  EXPECT_THAT(CompareFrame(Frame(7.0, {}), truth, {}), SizeIs(0));
  const auto compared =
      CompareFrame(Frame(0.7, {Found(kHub_m, 0.5, 0.1, StatusCode::kUnobservable)}), truth, {});
  ASSERT_THAT(compared, SizeIs(1));
  EXPECT_FALSE(compared[0].estimate);
}

TEST(CompareFrame, AForceKnownAlongTheNormalIsComparedAlongIt) {
  ComparedForce force;
  force.truth = TrueContact{"a", kHub_m, {0.3, 0.0, -0.4}};
  force.estimate = Found(kHub_m, 0.45, 0.1, StatusCode::kTangentialUnobservable);
  EXPECT_NEAR(ForceError_N(force), 0.05, 1e-9);
  force.estimate->status = Status::Ok();
  EXPECT_NEAR(ForceError_N(force), -0.05, 1e-9);
}

ComparedForce Compared(double true_N, const std::optional<ContactForce>& found, int true_forces) {
  ComparedForce force;
  force.truth = True("a", kHub_m, true_N);
  force.estimate = found;
  force.due = true;
  force.true_forces = true_forces;
  return force;
}

TEST(ComparisonSummary, KeepsSeenHiddenAndSeveralApart) {
  ComparisonSummary summary;
  const Eigen::Vector3d off_m(0.003, 0.0, 0.0);
  summary.Add({Compared(1.0, Found(kHub_m + off_m, 1.02), 1)});
  summary.Add({Compared(1.0, Found(kHub_m, 1.2), 1)});  // outside its interval
  summary.Add({Compared(1.0, Found(kHub_m, 0.9, 0.2, StatusCode::kHidden), 1)});
  summary.Add({Compared(1.0, Found(kHub_m, 1.04), 2), Compared(0.5, std::nullopt, 2)});
  ComparedForce false_alarm;
  false_alarm.estimate = Found(kLeg_m, 0.3);
  summary.Add({false_alarm, false_alarm});
  ComparedForce not_due = Compared(1.0, std::nullopt, 1);
  not_due.due = false;
  summary.Add({not_due});
  EXPECT_EQ(summary.frames(), 6);
  EXPECT_EQ(summary.found(), 4);
  EXPECT_EQ(summary.due(), 5);
  EXPECT_EQ(summary.misses(), 1);
  EXPECT_EQ(summary.false_alarms(), 2);
  EXPECT_EQ(summary.frames_with_false_alarm(), 1);
  EXPECT_EQ(summary.Seen().frames, 2);
  EXPECT_NEAR(summary.Seen().mean_relative_error, 0.11, 1e-9);
  EXPECT_NEAR(summary.Seen().coverage, 0.5, 1e-9);
  EXPECT_NEAR(summary.Seen().median_location_error_m, 0.003, 1e-9);
  EXPECT_NEAR(summary.Hidden().mean_relative_error, 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(summary.Hidden().mean_direction_error_rad));
  EXPECT_NEAR(summary.Together().mean_relative_error, 0.04, 1e-9);
  EXPECT_EQ(summary.Together().coverage, 1.0);
  EXPECT_EQ(summary.All().frames, 4);
  EXPECT_THAT(summary.ToText(), HasSubstr("1 of 5 steady forces were not detected"));
  EXPECT_THAT(summary.ToText(), HasSubstr("1 of 6 frames"));
  EXPECT_THAT(summary.ToText(), HasSubstr("11.0 % mean error over 2 frames"));
  EXPECT_THAT(ComparisonSummary().ToText(), Not(HasSubstr("nan")));
}

TEST(ComparisonSummary, MeasuresTheAngleBetweenTheForces) {
  ComparisonSummary summary;
  ComparedForce force = Compared(1.0, Found(kHub_m, 1.0), 1);
  force.estimate->force_N = {0.0, std::sin(0.2), -std::cos(0.2)};
  summary.Add({force});
  EXPECT_NEAR(summary.Seen().mean_direction_error_rad, 0.2, 1e-9);
}

TEST(LiveLine, SaysWhatIsFoundAndWhatIsTrue) {
  const TruthTimeline truth = Constant({True("ball", kHub_m, 0.5), True("other", kLeg_m, 0.7)});
  const ForceEstimate estimate = Frame(0.7, {Found(kHub_m, 0.512, 0.031)});
  const std::string line = LiveLine(estimate, CompareFrame(estimate, truth, {}));
  EXPECT_EQ(line,
            "   0.7 s  ok              ball 0.512 +- 0.031 N at (20, 0, 100) mm, true 0.500 N | "
            "other not detected, true 0.700 N");
  EXPECT_THAT(LiveLine(estimate, {}), HasSubstr("contact_1 0.512 +- 0.031 N"));
  const ForceEstimate hidden = Frame(0.7, {Found({-0.1, 0.0, 0.0}, 0.2, 0.1, StatusCode::kHidden)});
  EXPECT_THAT(LiveLine(hidden, CompareFrame(hidden, truth, {})), HasSubstr("out of view, true 0"));
  EXPECT_THAT(Cut(line, 20), SizeIs(20));
  EXPECT_EQ(Cut("short", 20), "short");
}

TEST(ForceTracks, HaveALineForEachTrueForceWithGaps) {
  ForceTracks tracks;
  const TruthTimeline truth = Constant({True("ball", kHub_m, 0.5)});
  const auto add = [&](const ForceEstimate& estimate) {
    tracks.Add(estimate.t_s, HasResult(estimate.status), CompareFrame(estimate, truth, {}));
  };
  ForceEstimate lost = Frame(0.1, {});
  lost.status = Status(StatusCode::kNoRobotSeen, "");
  add(lost);
  add(Frame(0.2, {Found(kHub_m, 0.4, 0.1)}));
  add(Frame(0.3, {Found(kHub_m, 0.45, 0.2, StatusCode::kHidden), Found(kLeg_m, 0.3)}));
  const auto lines = tracks.Tracks();
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[0].contact, "ball");
  EXPECT_TRUE(std::isnan(lines[0].true_N[0]));
  EXPECT_EQ(lines[0].true_N[1], 0.5);
  EXPECT_TRUE(std::isnan(lines[0].estimated_N[0]));
  EXPECT_EQ(lines[0].estimated_N[1], 0.4);
  EXPECT_EQ(lines[0].ci95_N[1], 0.1);
  EXPECT_TRUE(std::isnan(lines[0].estimated_N[2]));
  EXPECT_EQ(lines[0].hidden_N[2], 0.45);
  EXPECT_EQ(lines[1].contact, "no true force here");
  EXPECT_EQ(lines[1].estimated_N[2], 0.3);
  EXPECT_EQ(lines[1].true_N[2], 0.0);
}

}  // namespace
}  // namespace palpate::command
