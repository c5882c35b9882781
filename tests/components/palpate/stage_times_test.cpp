// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/stage_times.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace palpate::command {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

constexpr std::int64_t kPeriod_ns = 33'000'000;

constexpr std::array<Milestone, StageTimes::kStages> kWay = {
    Milestone::kReceived,   Milestone::kPublished, Milestone::kPerceiving, Milestone::kPerceived,
    Milestone::kEstimating, Milestone::kEstimated, Milestone::kHeard};

using Stages_ms = std::array<double, StageTimes::kStages>;

constexpr Stages_ms kUsual_ms = {14, 2, 1, 10, 1, 8, 1};

void AddFrame(std::int64_t stamp_ns, const Stages_ms& stages_ms, StageTimes* times) {
  times->AddState(stamp_ns);
  double age_ms = 0.0;
  for (std::size_t i = 0; i < kWay.size(); ++i) {
    age_ms += stages_ms[i];
    times->Pass(stamp_ns, kWay[i], 1e-3 * age_ms);
  }
  times->Finish(stamp_ns);
}

TEST(StageTimes, EachStageIsTheTimeSinceTheMilestoneBefore) {
  StageTimes times;
  for (int i = 0; i < 3; ++i) AddFrame(i * kPeriod_ns, kUsual_ms, &times);
  EXPECT_EQ(times.frames(), 3u);
  for (std::size_t i = 0; i < kWay.size(); ++i) {
    EXPECT_NEAR(times.Median_s(kWay[i]), 1e-3 * kUsual_ms[i], 1e-12);
  }
}

TEST(StageTimes, PartsOfAFrameMayBeToldInAnyOrderAndTheFirstWordCounts) {
  StageTimes times;
  double age_s = 0.07;
  for (auto milestone = kWay.rbegin(); milestone != kWay.rend(); ++milestone) {
    times.Pass(5, *milestone, age_s);
    times.Pass(5, *milestone, 1.0);
    age_s -= 0.01;
  }
  times.Finish(5);
  EXPECT_EQ(times.frames(), 1u);
  for (const Milestone milestone : kWay) EXPECT_NEAR(times.Median_s(milestone), 0.01, 1e-12);
}

TEST(StageTimes, AFrameOfWhichSomethingIsUnknownDoesNotCount) {
  StageTimes times;
  for (const Milestone milestone : kWay) {
    if (milestone != Milestone::kPerceived) times.Pass(5, milestone, 0.01);
  }
  times.Finish(5);
  times.Finish(6);
  EXPECT_EQ(times.frames(), 0u);
  EXPECT_TRUE(std::isnan(times.Median_s(Milestone::kPerceived)));
  EXPECT_EQ(times.ToText(), "");
}

TEST(StageTimes, FramesThatNeverArriveAreForgotten) {
  StageTimes times;
  times.Pass(0, Milestone::kReceived, 0.01);
  for (int i = 1; i <= 1000; ++i) times.Pass(i * kPeriod_ns, Milestone::kReceived, 0.01);
  for (const Milestone milestone : kWay) {
    if (milestone != Milestone::kReceived) times.Pass(0, milestone, 0.02);
  }
  times.Finish(0);
  EXPECT_EQ(times.frames(), 0u);
}

TEST(StageTimes, SaysHowManyFramesEachProcessHadBetweenTheFirstAndTheLastThatWasEstimated) {
  StageTimes times;
  times.AddState(-kPeriod_ns);  // before anybody listened
  AddFrame(0, kUsual_ms, &times);
  times.AddState(kPeriod_ns);  // no picture of it
  times.AddState(2 * kPeriod_ns);
  times.Pass(2 * kPeriod_ns, Milestone::kPublished, 0.01);  // but not perceived
  times.AddState(3 * kPeriod_ns);
  times.Pass(3 * kPeriod_ns, Milestone::kPublished, 0.01);
  times.Pass(3 * kPeriod_ns, Milestone::kPerceived, 0.02);  // but not estimated
  AddFrame(4 * kPeriod_ns, kUsual_ms, &times);
  times.AddState(5 * kPeriod_ns);  // still on its way
  EXPECT_THAT(times.ToText(), HasSubstr("5 states, 4 frames captured, 3 perceived, 2 estimated\n"));
}

TEST(StageTimes, ShowsWhereTheSlowestFramesLoseTheirTime) {
  StageTimes times;
  for (int i = 0; i < 200; ++i) AddFrame(i * kPeriod_ns, kUsual_ms, &times);
  Stages_ms slow = kUsual_ms;
  slow[5] = 300.0;
  AddFrame(200 * kPeriod_ns, slow, &times);
  AddFrame(201 * kPeriod_ns, slow, &times);
  EXPECT_THAT(times.ToText(), HasSubstr("  estimation              8.0    8.0  300.0\n"));
  EXPECT_THAT(times.ToText(), HasSubstr("  perception             10.0   10.0   10.0\n"));
}

TEST(StageTimes, TheTableOfFramesHoldsStagesAndTheirSum) {
  StageTimes times;
  AddFrame(7 * kPeriod_ns, kUsual_ms, &times);
  AddFrame(8 * kPeriod_ns, kUsual_ms, &times);
  const std::string row = "14.000,2.000,1.000,10.000,1.000,8.000,1.000,37.000\n";
  EXPECT_THAT(times.ToCsv(), MatchesRegex("t_s,.*,sum_ms\n0.000," + row + "0.033," + row));
}

}  // namespace
}  // namespace palpate::command
