// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/guard.hpp"

#include <gtest/gtest.h>

#include "tests/components/diagnosis_core/toy_causes.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kGuardSeed = 31;
const Eigen::Matrix3Xd kOneMarker_m = Eigen::Vector3d::Zero();

TEST(Guard, AlarmsAboutARightModelAsOftenAsItMeansTo) {
  const CauseBook book = ToyBook();
  ToyData data(book, kGuardSeed);
  for (const std::vector<int>& faults : {std::vector<int>{}, std::vector<int>{0}}) {
    constexpr int kRobots = 300;
    int alarms = 0;
    for (int k = 0; k < kRobots; ++k) {
      const Fit fit = data.FitTo(book, data.Draw(book.BeliefWith(faults)), faults);
      if (!Guard(data.observed, kOneMarker_m, book, fit, 200, kGuardSeed + static_cast<unsigned>(k))
               .passed)
        ++alarms;
    }
    // 2 % of 300 is 6 +- 2.4, and as much again for thresholds from 200 draws.
    EXPECT_GE(alarms, 1) << "seed " << kGuardSeed;
    EXPECT_LE(alarms, 15) << "seed " << kGuardSeed;
  }
}

TEST(Guard, SeesAPatternThatNoCauseMakes) {
  const CauseBook book = ToyBook();
  ToyData data(book, kGuardSeed);
  constexpr int kRobots = 100;
  int seen = 0;
  int named = 0;
  for (int k = 0; k < kRobots; ++k) {
    Eigen::VectorXd y = data.Draw(book.BeliefWith({}));
    // One and a half sigma in one axis of one recording, all the time, and less in another.
    y.segment(36, 12).array() += 1.5;
    y.segment(48, 12).array() -= 1.0;
    const GuardResult result =
        Guard(data.observed, kOneMarker_m, book, data.FitTo(book, y, {}), 200, kGuardSeed);
    seen += result.passed ? 0 : 1;
    named += result.worst.ends_with("recording r1") ? 1 : 0;
  }
  EXPECT_GE(seen, 95) << "seed " << kGuardSeed;
  EXPECT_GE(named, 95) << "seed " << kGuardSeed;
}

TEST(Guard, SaysTheSameOfTheSameData) {
  const CauseBook book = ToyBook();
  ToyData data(book, kGuardSeed);
  const Fit fit = data.FitTo(book, data.Draw(book.BeliefWith({})), {});
  EXPECT_EQ(Guard(data.observed, kOneMarker_m, book, fit).surprise,
            Guard(data.observed, kOneMarker_m, book, fit).surprise);
}

}  // namespace
}  // namespace palpate::diagnosis
