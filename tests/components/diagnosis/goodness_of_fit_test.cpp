// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/goodness_of_fit.hpp"

#include <gtest/gtest.h>

#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kGoodnessOfFitSeed = 31;
const Eigen::Matrix3Xd kOneMarker_m = Eigen::Vector3d::Zero();

TEST(TestGoodnessOfFit, AlarmsAboutARightModelAsOftenAsItMeansTo) {
  const HypothesisSet hypotheses = ToyBook();
  ToyData data(hypotheses, kGoodnessOfFitSeed);
  for (const std::vector<int>& faults : {std::vector<int>{}, std::vector<int>{0}}) {
    constexpr int kRobots = 300;
    int alarms = 0;
    for (int k = 0; k < kRobots; ++k) {
      const Fit fit = data.FitTo(hypotheses, data.Draw(hypotheses.PriorWith(faults)), faults);
      if (!TestGoodnessOfFit(data.observed, kOneMarker_m, hypotheses, fit, 200,
                             kGoodnessOfFitSeed + static_cast<unsigned>(k))
               .passed)
        ++alarms;
    }
    // 2 % of 300 is 6 +- 2.4, and as much again for thresholds from 200 draws.
    EXPECT_GE(alarms, 1) << "seed " << kGoodnessOfFitSeed;
    EXPECT_LE(alarms, 15) << "seed " << kGoodnessOfFitSeed;
  }
}

TEST(TestGoodnessOfFit, SeesAPatternThatNoCauseMakes) {
  const HypothesisSet hypotheses = ToyBook();
  ToyData data(hypotheses, kGoodnessOfFitSeed);
  constexpr int kRobots = 100;
  int seen = 0;
  int named = 0;
  for (int k = 0; k < kRobots; ++k) {
    Eigen::VectorXd y = data.Draw(hypotheses.PriorWith({}));
    // One and a half sigma in one axis of one recording, all the time, and less in another.
    y.segment(36, 12).array() += 1.5;
    y.segment(48, 12).array() -= 1.0;
    const GoodnessOfFit result =
        TestGoodnessOfFit(data.observed, kOneMarker_m, hypotheses, data.FitTo(hypotheses, y, {}),
                          200, kGoodnessOfFitSeed);
    seen += result.passed ? 0 : 1;
    named += result.worst.ends_with("recording r1") ? 1 : 0;
  }
  EXPECT_GE(seen, 95) << "seed " << kGoodnessOfFitSeed;
  EXPECT_GE(named, 95) << "seed " << kGoodnessOfFitSeed;
}

TEST(TestGoodnessOfFit, SaysTheSameOfTheSameData) {
  const HypothesisSet hypotheses = ToyBook();
  ToyData data(hypotheses, kGoodnessOfFitSeed);
  const Fit fit = data.FitTo(hypotheses, data.Draw(hypotheses.PriorWith({})), {});
  EXPECT_EQ(TestGoodnessOfFit(data.observed, kOneMarker_m, hypotheses, fit).surprise,
            TestGoodnessOfFit(data.observed, kOneMarker_m, hypotheses, fit).surprise);
}

}  // namespace
}  // namespace palpate::diagnosis
