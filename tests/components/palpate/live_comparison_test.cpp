// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/live_comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace palpate::command {
namespace {

using force_estimation::ForceEstimate;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

const Eigen::Vector3d kLiveHub_m(0.02, 0.0, 0.1);

ForceEstimate Frame(double t_s, double pushed_N) {
  ForceEstimate estimate;
  estimate.t_s = t_s;
  estimate.status = pushed_N > 0.0 ? Status::Ok() : Status(StatusCode::kNoContact, "");
  if (pushed_N > 0.0) {
    force_estimation::ContactForce contact;
    contact.name = "contact_1";
    contact.status = Status::Ok();
    contact.position_m = kLiveHub_m;
    contact.force_N = {0.0, 0.0, -pushed_N};
    contact.ci95_N = 0.1;
    estimate.contacts = {contact};
  }
  return estimate;
}

class LiveComparisonTest : public testing::Test {
 protected:
  void AddTruth(double t_s, double pushed_N) {
    comparison_.AddTruth(t_s, {{"ball", kLiveHub_m, {0.0, 0.0, -pushed_N}}});
  }
  void Advance() {
    comparison_.Advance([&](const ForceEstimate& estimate, const std::vector<ComparedForce>& all) {
      times_s_.push_back(estimate.t_s);
      compared_.push_back(all);
    });
  }
  LiveComparison comparison_{true};
  std::vector<double> times_s_;
  std::vector<std::vector<ComparedForce>> compared_;
};

TEST_F(LiveComparisonTest, AnEstimateWaitsForTheTruthOfItsTime) {
  AddTruth(100.0, 0.5);
  comparison_.AddEstimate(Frame(100.01, 0.4), 0.03);
  Advance();
  EXPECT_THAT(times_s_, SizeIs(0));
  AddTruth(100.03, 0.5);
  Advance();
  EXPECT_THAT(times_s_, ElementsAre(100.01));
  ASSERT_THAT(compared_[0], SizeIs(1));
  EXPECT_EQ(compared_[0][0].truth->name, "ball");
  EXPECT_EQ(comparison_.summary().frames(), 1);
}

TEST_F(LiveComparisonTest, WithoutTruthForLongAFrameGoesUncompared) {
  comparison_.AddEstimate(Frame(100.0, 0.4), 0.03);
  comparison_.AddEstimate(Frame(100.4, 0.4), 0.03);
  Advance();
  EXPECT_THAT(times_s_, SizeIs(0));
  comparison_.AddEstimate(Frame(100.6, 0.4), 0.03);
  Advance();
  EXPECT_THAT(times_s_, ElementsAre(100.0));
  EXPECT_THAT(compared_[0], SizeIs(0));
  EXPECT_EQ(comparison_.summary().frames(), 0);
  EXPECT_EQ(comparison_.summary().false_alarms(), 0);  // unknown
}

TEST_F(LiveComparisonTest, KeepsTheMomentOfMostSteadyForceForThePicture) {
  for (int i = 0; i < 20; ++i) {
    const double t_s = 100.0 + 0.03125 * i;
    const double pushed_N = i < 5 ? 0.4 * (i + 1) : 0.5 + 1e-4 * i;  // 2 N, not for long
    AddTruth(t_s, pushed_N);
    comparison_.AddNodes(t_s, Eigen::VectorXd::Constant(3, i));
    comparison_.AddEstimate(Frame(t_s, pushed_N), 0.02 + 0.001 * i);
    Advance();
  }
  ASSERT_TRUE(comparison_.best());
  EXPECT_EQ(comparison_.best()->nodes_m[0], 19.0);
  EXPECT_NEAR(comparison_.best()->t_s, 19 * 0.03125, 1e-9);  // from the first frame on
  EXPECT_NEAR(comparison_.Rate_hz(), 32.0, 1e-6);
  EXPECT_EQ(comparison_.results(), 20);
  EXPECT_THAT(comparison_.ToText(), HasSubstr("20, 32.0 Hz; 20 ok"));
  EXPECT_THAT(comparison_.ToText(), HasSubstr("30 ms median, 39 ms p99, from exposure"));
  EXPECT_THAT(comparison_.ToText(), HasSubstr("0 of 20 frames"));
  ASSERT_THAT(comparison_.Tracks(), SizeIs(1));
  EXPECT_THAT(comparison_.Tracks()[0].t_s, SizeIs(20));
  EXPECT_EQ(comparison_.Tracks()[0].t_s[0], 0.0);
}

TEST_F(LiveComparisonTest, WhatMustBeDetectedIsAShareOfTheLargestForce) {
  const auto is_due = [&](double t_s, double pushed_N) {
    for (int i = 0; i < 4; ++i) AddTruth(t_s + 0.125 * i, pushed_N);
    comparison_.AddEstimate(Frame(t_s + 0.375, 0.0), 0.0);
    Advance();
    return compared_.back().at(0).due;
  };
  EXPECT_TRUE(is_due(100.0, 0.02));  // of a soft robot
  EXPECT_TRUE(is_due(101.0, 0.15));
  EXPECT_FALSE(is_due(102.0, 0.014));
}

TEST_F(LiveComparisonTest, ASlowBenchHasSteadyForcesToo) {
  for (int i = 0; i < 4; ++i) AddTruth(100.0 + 2.0 * i, i == 3 ? 0.4 : 0.3);
  for (int i = 1; i < 4; ++i) comparison_.AddEstimate(Frame(100.0 + 2.0 * i, 0.3), 0.0);
  Advance();
  ASSERT_THAT(compared_, SizeIs(3));
  EXPECT_TRUE(compared_[0].at(0).due);
  EXPECT_TRUE(compared_[1].at(0).due);
}

TEST_F(LiveComparisonTest, TheRateIsThatWithARobot) {
  const auto add = [&](double t_s, StatusCode code) {
    ForceEstimate frame = Frame(t_s, 0.0);
    frame.status = Status(code, "");
    comparison_.AddEstimate(frame, std::nullopt);
  };
  add(100.0, StatusCode::kNoRobotSeen);  // the camera is there first
  EXPECT_TRUE(std::isnan(comparison_.Rate_hz()));
  for (int i = 0; i < 5; ++i) add(102.0 + 0.25 * i, StatusCode::kNoContact);
  add(103.25, StatusCode::kNoRobotSeen);  // it was covered
  EXPECT_NEAR(comparison_.Rate_hz(), 4.0, 1e-9);
  EXPECT_EQ(comparison_.frames(), 7);
}

TEST_F(LiveComparisonTest, AStaleAnswerIsNoFrame) {
  ForceEstimate stale = Frame(100.0, 0.0);
  stale.status = Status(StatusCode::kStale, "no frames for 2 s");
  comparison_.AddEstimate(stale, 2.0);
  EXPECT_EQ(comparison_.frames(), 0);
  EXPECT_THAT(comparison_.ToText(), HasSubstr("1 stale"));
}

TEST_F(LiveComparisonTest, AForceWhereNothingPushesMakesNoPicture) {
  comparison_.AddTruth(100.0, {});
  comparison_.AddNodes(100.0, Eigen::VectorXd::Zero(3));
  comparison_.AddEstimate(Frame(100.0, 0.4), 0.03);
  Advance();
  EXPECT_FALSE(comparison_.best());
  EXPECT_EQ(comparison_.summary().false_alarms(), 1);
}

TEST(LiveComparison, OfRecordingsEstimatesStandAlone) {
  LiveComparison comparison(false);
  comparison.AddNodes(1.0, Eigen::VectorXd::Zero(3));
  comparison.AddEstimate(Frame(1.0, 0.4), std::nullopt);
  int shown = 0;
  comparison.Advance([&](const ForceEstimate&, const std::vector<ComparedForce>& all) {
    ++shown;
    EXPECT_THAT(all, SizeIs(0));
  });
  EXPECT_EQ(shown, 1);
  EXPECT_TRUE(comparison.best());
  ASSERT_THAT(comparison.Tracks(), SizeIs(1));
  EXPECT_EQ(comparison.Tracks()[0].contact, "contact_1");
  EXPECT_THAT(comparison.Tracks()[0].true_N, SizeIs(0));
  EXPECT_THAT(comparison.ToText(), Not(HasSubstr("misses")));
  EXPECT_THAT(comparison.ToText(), Not(HasSubstr("latency")));
}

}  // namespace
}  // namespace palpate::command
