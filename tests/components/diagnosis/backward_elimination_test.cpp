// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/backward_elimination.hpp"

#include <gmock/gmock.h>

#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kClearEvidence = 10.0;

class BackwardCheck : public HiddenFaults {
 protected:
  /// As it would stand where these were named one after the other.
  Selection Named(const Fitter& fitter, const std::vector<int>& faults) const {
    Selection selection;
    selection.null_model = fitter.AsBuilt();
    selection.best = fitter.Complete(fitter.Refine(faults, selection.null_model));
    for (const int fault : faults) {
      Choice& choice = selection.named.emplace_back(Choice{.fault = fault});
      choice.ln_gain_of_recording.resize(observed_.recordings.size());
    }
    return selection;
  }
};

TEST_F(BackwardCheck, ExchangesAWrongCauseForTheRightOneOnceAnotherIsKnown) {
  Measure({{"cable_gain", "cable:up", 0.1}, {"density", "body", 0.3}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const int right = Number("cable_gain", "cable:up");
  const int other = Number("density", "body");
  Selection selection = Named(fitter, {Number("cable_offset", "cable:up"), other});
  const double before = selection.best.posterior.ln_evidence;
  EliminateBackward(fitter, kClearEvidence, &selection);
  EXPECT_THAT(selection.best.faults, testing::UnorderedElementsAre(right, other))
      << "seed " << kSeed;
  ASSERT_EQ(selection.named.size(), 2U);
  EXPECT_EQ(selection.named[0].fault, right);
  EXPECT_GT(selection.named[0].probability, 0.9);
  EXPECT_GT(selection.best.posterior.ln_evidence, before + kClearEvidence);
}

TEST_F(BackwardCheck, DropsWhatTheOthersLeaveNoEvidenceFor) {
  Measure({{"cable_gain", "cable:up", 0.1}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const int right = Number("cable_gain", "cable:up");
  Selection selection = Named(fitter, {Number("gravity_direction", "base"), right});
  EliminateBackward(fitter, kClearEvidence, &selection);
  EXPECT_THAT(selection.best.faults, testing::ElementsAre(right)) << "seed " << kSeed;
  EXPECT_EQ(selection.named.size(), 1U);
}

TEST_F(BackwardCheck, KeepsWhatIsRight) {
  Measure({{"cable_gain", "cable:up", 0.1}, {"density", "body", 0.3}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const std::vector<int> right{Number("cable_gain", "cable:up"), Number("density", "body")};
  Selection selection = Named(fitter, right);
  EliminateBackward(fitter, kClearEvidence, &selection);
  EXPECT_EQ(selection.best.faults, right) << "seed " << kSeed;
}

}  // namespace
}  // namespace palpate::diagnosis
