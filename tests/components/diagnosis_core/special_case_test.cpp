// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis_core/hidden_causes.hpp"

namespace palpate::diagnosis {
namespace {

/// A mass, and a force sideways of a size beside it.
class SpecialCase : public HiddenCauses {
 protected:
  static constexpr double kLittle_N = 0.004;
  static constexpr double kMuch_N = 0.1;

  Selection Select(double force_N) {
    Measure({{"payload", "body", 0.01}, {"permanent_force", "body", force_N, 1}});
    const Fitter fitter(observed_, body_, book_, {}, 1);
    return SelectCauses(observed_, fitter, fitter.AsBuilt(), 1, [](int, int, const auto&) {});
  }
  std::string IdOf(int cause) const { return book_.cause(cause).name().id; }
  double LnBayesFactorOf(const std::string& id, const Selection& selection) const {
    for (const Candidate& one : selection.candidates) {
      if (IdOf(one.cause) == id) return one.ln_bayes_factor;
    }
    ADD_FAILURE() << "no " << id;
    return 0.0;
  }
};

TEST_F(SpecialCase, StandsWhereTheGeneralCauseIsNotClearlyBetter) {
  const Selection selection = Select(kLittle_N);
  ASSERT_EQ(selection.named.size(), 1U);
  const double better =
      LnBayesFactorOf("permanent_force", selection) - LnBayesFactorOf("payload", selection);
  ASSERT_NEAR(better, 0.0, 3.0) << "else it would not be alike; seed " << kSeed;
  EXPECT_EQ(IdOf(selection.named[0].cause), "payload");
  EXPECT_GT(selection.named[0].probability, 0.9);
  for (const Candidate& alike : selection.alike) EXPECT_NE(IdOf(alike.cause), "permanent_force");
}

TEST_F(SpecialCase, GivesWayToTheGeneralCauseThatIs) {
  const Selection selection = Select(kMuch_N);
  ASSERT_EQ(selection.named.size(), 1U);
  EXPECT_EQ(IdOf(selection.named[0].cause), "permanent_force");
}

}  // namespace
}  // namespace palpate::diagnosis
