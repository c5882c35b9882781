// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

class SearchTime : public HiddenFaults {
 protected:
  SearchTime() { Measure({{"cable_gain", "cable:up", 0.1}, {"density", "body", 0.3}}); }

  Selection Select(TimeLimit limit) {
    const Fitter fitter(observed_, body_, hypotheses_, {}, 1, limit);
    return SelectFaults(observed_, fitter, fitter.AsBuilt(), 3, [](int, int, const auto&) {});
  }
};

TEST_F(SearchTime, WithoutAnEndFindsBoth) {
  const Selection selection = Select({});
  EXPECT_EQ(selection.named.size(), 2U);
  EXPECT_TRUE(selection.complete);
}

TEST_F(SearchTime, ThatIsOverLeavesTheFirstCauseAndSaysSo) {
  constexpr double kAtOnce_s = 1e-9;
  const Selection selection = Select(TimeLimit(kAtOnce_s));
  EXPECT_EQ(selection.named.size(), 1U);
  EXPECT_FALSE(selection.complete);
  EXPECT_TRUE(selection.best.status.ok());
}

/// Else whatever is fitted after it looks better than none.
TEST_F(SearchTime, ThatIsOverFitsAHealthyRobotToItsEnd) {
  const Fitter in_time(observed_, body_, hypotheses_, {}, 1);
  const Fitter late(observed_, body_, hypotheses_, {}, 1, TimeLimit(1e-9));
  const Fit fit = in_time.Complete(in_time.AsBuilt());
  EXPECT_NE(fit.z, in_time.AsBuilt().z);
  EXPECT_EQ(late.Complete(late.AsBuilt()).z, fit.z);
}

TEST(TimeLimit, IsOverAfterItsTimeAndNeverWithoutOne) {
  EXPECT_TRUE(TimeLimit(1e-9).IsOver());
  EXPECT_FALSE(TimeLimit(1e6).IsOver());
  EXPECT_FALSE(TimeLimit(0.0).IsOver());
  EXPECT_FALSE(TimeLimit().IsOver());
}

TEST(SamplesWithin, AreAllWithoutALimitAndNeverFewerThanTen) {
  EXPECT_EQ(SamplesWithin(0.0, 5.0, 120), 120u);
  EXPECT_EQ(SamplesWithin(600.0, 5.0, 120), 120u);
  EXPECT_EQ(SamplesWithin(60.0, 1.0, 120), 60u);
  EXPECT_EQ(SamplesWithin(60.0, 50.0, 120), 10u);
  EXPECT_EQ(SamplesWithin(60.0, 50.0, 7), 7u);
  EXPECT_EQ(SamplesWithin(60.0, 0.0, 120), 120u);
}

TEST(SpreadOver, TakesAsManyAsItMayInOrder) {
  EXPECT_EQ(SpreadOver(10, 5), (std::vector<std::size_t>{0, 2, 4, 6, 8}));
  EXPECT_EQ(SpreadOver(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(SpreadOver(0, 5).empty());
}

TEST(TimeLimit, IsOverOnceAStopIsRequested) {
  bool stop = false;
  const TimeLimit limit(0.0, [&] { return stop; });
  EXPECT_FALSE(limit.IsOver());
  stop = true;
  EXPECT_TRUE(limit.IsOver());
  EXPECT_TRUE(limit.IsStopped());
  EXPECT_FALSE(TimeLimit(1e-9).IsStopped());
}

}  // namespace
}  // namespace palpate::diagnosis
