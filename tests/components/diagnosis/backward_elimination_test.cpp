// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/backward_elimination.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

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
    selection.best =
        fitter.WithAllFaults(fitter.Complete(fitter.Refine(faults, selection.null_model)));
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

/// A small mass somewhere on the body bends it as a heavier body does.
TEST_F(BackwardCheck, NamesRivalsThatFitAsWellBesideTheOthers) {
  Measure({{"cable_gain", "cable:up", 0.1}, {"density", "body", 0.22}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const int density = Number("density", "body");
  const int gain = Number("cable_gain", "cable:up");
  Selection selection = Named(fitter, {density, gain});
  EliminateBackward(fitter, kClearEvidence, &selection);
  ASSERT_EQ(selection.named.size(), 2U);
  const auto payload =
      std::find_if(selection.indistinguishable.begin(), selection.indistinguishable.end(),
                   [&](const Candidate& one) {
                     return hypotheses_.model(one.fault).name() == CauseName{"payload", {"body"}};
                   });
  ASSERT_NE(payload, selection.indistinguishable.end()) << "seed " << kSeed;
  EXPECT_EQ(payload->in_place_of, density);
  EXPECT_GT(payload->ln_exchanged, -kSelectionTuning.indistinguishable_evidence);
  EXPECT_LE(payload->ln_exchanged, 0.0);
  const Fit other =
      fitter.Complete(fitter.Refine({payload->fault, gain}, fitter.Complete(fitter.AsBuilt())));
  EXPECT_NEAR(other.posterior.ln_evidence - selection.best.posterior.ln_evidence,
              payload->ln_exchanged, 0.5);
  EXPECT_LE(selection.named[0].probability, 1.0 / (1.0 + std::exp(payload->ln_exchanged)));
}

TEST_F(BackwardCheck, DropsTheRivalsOfWhatItDrops) {
  Measure({{"cable_gain", "cable:up", 0.1}, {"density", "body", 0.15}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const int gain = Number("cable_gain", "cable:up");
  Selection selection = Named(fitter, {Number("density", "body"), gain});
  EliminateBackward(fitter, kClearEvidence, &selection);
  EXPECT_THAT(selection.best.faults, testing::ElementsAre(gain)) << "seed " << kSeed;
  EXPECT_THAT(selection.indistinguishable, testing::IsEmpty());
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
