// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

/// A mass, and a force sideways beside it.
class SpecialCase : public HiddenFaults {
 protected:
  Selection Select(double force_N) {
    Measure({{"payload", "body", 0.01}, {"permanent_force", "body", force_N, 1}});
    const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
    return SelectFaults(observed_, fitter, fitter.AsBuilt(), 1, [](int, int, const auto&) {});
  }
  std::string IdOf(int cause) const { return hypotheses_.model(cause).name().id; }
  double LnBayesFactorOf(const std::string& id, const Selection& selection) const {
    for (const Candidate& one : selection.candidates) {
      if (IdOf(one.fault) == id) return one.ln_bayes_factor;
    }
    ADD_FAILURE() << "no " << id;
    return 0.0;
  }
  bool IsIndistinguishable(const std::string& id, const Selection& selection) const {
    return std::any_of(selection.indistinguishable.begin(), selection.indistinguishable.end(),
                       [&](const Candidate& one) { return IdOf(one.fault) == id; });
  }
};

TEST_F(SpecialCase, IsNamedWhereTheGeneralCauseHasNoNeedOfWhatElseItCanDo) {
  const Selection selection = Select(0.0);
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  const double better =
      LnBayesFactorOf("payload", selection) - LnBayesFactorOf("permanent_force", selection);
  ASSERT_GT(better, kSelectionTuning.indistinguishable_evidence);
  EXPECT_EQ(IdOf(selection.named[0].fault), "payload");
  EXPECT_NEAR(selection.named[0].probability, 1.0 / (1.0 + std::exp(-better)), 1e-3);
  EXPECT_FALSE(IsIndistinguishable("permanent_force", selection));
}

TEST_F(SpecialCase, IsAlikeAsOtherCausesAreHoweverMuchTheirEffectsAreTheSame) {
  const int force = Number("permanent_force", "body");
  const int mass = Number("payload", "body");
  constexpr double kSame = 0.999;
  EXPECT_EQ(
      IndistinguishableWithin(hypotheses_, force, {.fault = mass, .canonical_correlation = kSame}),
      kSelectionTuning.indistinguishable_evidence);
  const int other = Number("density", "body");
  EXPECT_EQ(
      IndistinguishableWithin(hypotheses_, force, {.fault = other, .canonical_correlation = kSame}),
      kSelectionTuning.clear_evidence);
  EXPECT_EQ(
      IndistinguishableWithin(hypotheses_, force, {.fault = other, .canonical_correlation = 0.9}),
      kSelectionTuning.indistinguishable_evidence);
}

TEST_F(SpecialCase, GivesWayToTheGeneralCauseWithMoreEvidenceThanAlikeOnesHave) {
  const Selection selection = Select(-0.018);
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  const double behind =
      LnBayesFactorOf("permanent_force", selection) - LnBayesFactorOf("payload", selection);
  ASSERT_GT(behind, kSelectionTuning.indistinguishable_evidence);
  ASSERT_LT(behind, kSelectionTuning.clear_evidence)
      << "their effects are much the same: that does not make them alike";
  EXPECT_EQ(IdOf(selection.named[0].fault), "permanent_force");
  EXPECT_FALSE(IsIndistinguishable("payload", selection));
}

}  // namespace
}  // namespace palpate::diagnosis
