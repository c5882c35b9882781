// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kGainBesideEnds = 0.1;
constexpr double kLessThanTheMesh = -1.5;

/// What the mesh yields by where cables end, as a diagnosis counts with it.
class AnchorCompliance : public HiddenFaults {
 protected:
  AnchorCompliance() : HiddenFaults(SmallRobot(), SmallExperimentOfEachCable(SmallRobot())) {
    without_ = std::move(hypotheses_);
    hypotheses_ = HypothesisSet(MakeFaultModels({.body = body_, .observed = observed_}, {}), {});
  }

  /// Error of the estimated gain against the hidden one, in standard deviations.
  double Off(const HypothesisSet& hypotheses) const {
    const Fitter fitter(observed_, body_, hypotheses, {}, 1);
    int gain = 0;
    while (hypotheses.model(gain).name() != CauseName{"cable_gain", {"cable:up"}}) ++gain;
    const Fit fit = fitter.Complete(fitter.Refine({gain}, fitter.AsBuilt()));
    const Eigen::Index at = hypotheses.first(gain);
    return (fit.posterior.mean[at] - kGainBesideEnds) / std::sqrt(fit.posterior.covariance(at, at));
  }

  HypothesisSet without_{{}, {}};
};

TEST_F(AnchorCompliance, AreNoFault) {
  Measure({{"cable_ends", "body", kLessThanTheMesh}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Selection selection =
      SelectFaults(observed_, fitter, fitter.AsBuilt(), 1, [](int, int, const auto&) {});
  EXPECT_TRUE(selection.named.empty()) << "seed " << kSeed;
  EXPECT_NEAR(selection.null_model.posterior.mean[ColumnOf("cable_ends", "body")], kLessThanTheMesh,
              0.5);
}

TEST_F(AnchorCompliance, LeaveAGainWhereItIs) {
  Measure({{"cable_gain", "cable:up", kGainBesideEnds}, {"cable_ends", "body", kLessThanTheMesh}});
  EXPECT_LT(std::abs(Off(hypotheses_)), 2.0) << "seed " << kSeed;
  EXPECT_GT(std::abs(Off(without_)), 3.0) << "else the test shows nothing";
}

}  // namespace
}  // namespace palpate::diagnosis
