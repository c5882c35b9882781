// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>

#include "tests/system/blind/plan_set.hpp"
#include "tests/system/blind/two_at_a_time.hpp"

namespace palpate::blind {
namespace {

PlanRecord Answered(bool by_the_proposed, bool by_one_drawn) {
  PlanRecord record;
  record.proposed.separated = by_the_proposed;
  record.drawn.separated = by_one_drawn;
  return record;
}

TEST(PlanScore, CountsQuestionsThatWereThere) {
  PlanRecord none = Answered(false, false);
  none.no_question = "nothing fits as well";
  const PlanScore score = Judge({Answered(true, false), none, Answered(true, true), none});
  EXPECT_EQ(score.proposed.hits, 2);
  EXPECT_EQ(score.proposed.count, 2);
  EXPECT_EQ(score.drawn.hits, 1);
  EXPECT_EQ(score.drawn.count, 2);
}

TEST(TwoAtATime, TakesEachOnceUntilOneIsTheLast) {
  constexpr std::size_t kLast = 20;
  std::atomic<int> taken[kLast + 3] = {};
  TwoAtATime([&](std::size_t k) {
    ++taken[k];
    return k < kLast;
  });
  for (std::size_t k = 0; k <= kLast; ++k) EXPECT_EQ(taken[k], 1) << k;
}

TEST(TwoAtATime, EndsWithWhatIsThrown) {
  const auto fails = [](std::size_t k) {
    if (k == 3) throw std::runtime_error("the fourth");
    return true;
  };
  EXPECT_THROW(TwoAtATime(fails), std::runtime_error);
}

}  // namespace
}  // namespace palpate::blind
