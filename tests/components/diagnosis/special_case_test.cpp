// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/hidden_causes.hpp"

namespace palpate::diagnosis {
namespace {

/// A mass, and a force sideways beside it.
class SpecialCase : public HiddenCauses {
 protected:
  Selection Select(double force_N) {
    Measure({{"payload", "body", 0.01}, {"permanent_force", "body", force_N, 1}});
    const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
    return SelectCauses(observed_, fitter, fitter.AsBuilt(), 1, [](int, int, const auto&) {});
  }
  std::string IdOf(int cause) const { return hypotheses_.cause(cause).name().id; }
  double LnBayesFactorOf(const std::string& id, const Selection& selection) const {
    for (const Candidate& one : selection.candidates) {
      if (IdOf(one.cause) == id) return one.ln_bayes_factor;
    }
    ADD_FAILURE() << "no " << id;
    return 0.0;
  }
  bool IsAlike(const std::string& id, const Selection& selection) const {
    return std::any_of(selection.alike.begin(), selection.alike.end(),
                       [&](const Candidate& one) { return IdOf(one.cause) == id; });
  }
};

TEST_F(SpecialCase, IsNamedWhereTheGeneralCauseHasNoNeedOfWhatElseItCanDo) {
  const Selection selection = Select(0.0);
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  const double better =
      LnBayesFactorOf("payload", selection) - LnBayesFactorOf("permanent_force", selection);
  ASSERT_GT(better, kAlikeEvidence);
  EXPECT_EQ(IdOf(selection.named[0].cause), "payload");
  EXPECT_NEAR(selection.named[0].probability, 1.0 / (1.0 + std::exp(-better)), 1e-3);
  EXPECT_FALSE(IsAlike("permanent_force", selection));
}

TEST_F(SpecialCase, IsAlikeAsOtherCausesAreHoweverMuchTheirEffectsAreTheSame) {
  const int force = Number("permanent_force", "body");
  const int mass = Number("payload", "body");
  constexpr double kSame = 0.999;
  EXPECT_EQ(AlikeWithin(hypotheses_, force, {.cause = mass, .canonical_correlation = kSame}),
            kAlikeEvidence);
  const int other = Number("density", "body");
  EXPECT_EQ(AlikeWithin(hypotheses_, force, {.cause = other, .canonical_correlation = kSame}),
            kClearEvidence);
  EXPECT_EQ(AlikeWithin(hypotheses_, force, {.cause = other, .canonical_correlation = 0.9}),
            kAlikeEvidence);
}

TEST_F(SpecialCase, GivesWayToTheGeneralCauseWithMoreEvidenceThanAlikeOnesHave) {
  const Selection selection = Select(-0.017);
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  const double behind =
      LnBayesFactorOf("permanent_force", selection) - LnBayesFactorOf("payload", selection);
  ASSERT_GT(behind, kAlikeEvidence);
  ASSERT_LT(behind, kClearEvidence)
      << "their effects are much the same: that does not make them alike";
  EXPECT_EQ(IdOf(selection.named[0].cause), "permanent_force");
  EXPECT_FALSE(IsAlike("payload", selection));
}

}  // namespace
}  // namespace palpate::diagnosis
