// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kHiddenGain = 0.1;

/// A gain of the same cable with a wider prior.
class Twin final : public FaultModel {
 public:
  explicit Twin(double fault)
      : FaultModel({"twin", {"cable:up"}}, "a gain's twin",
                   {{.name = "z", .tolerance = 0.005, .fault = fault}}) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.gain[0] += z[0];
  }
};

class SameEffect : public HiddenFaults {
 protected:
  /// With a twin of the gain that is hidden beside the real faults.
  Selection Select(double fault_of_twin) {
    Measure({{"cable_gain", "cable:up", kHiddenGain}});
    std::vector<FaultModelPtr> causes = Causes();
    causes.push_back(std::make_unique<Twin>(fault_of_twin));
    with_twin_ =
        std::make_unique<HypothesisSet>(std::move(causes), std::map<std::string, double>());
    const Fitter fitter(observed_, body_, *with_twin_, {}, 1);
    return SelectFaults(observed_, fitter, fitter.AsBuilt(), 1, [](int, int, const auto&) {});
  }
  const Candidate& Find(const std::string& id, const Selection& selection) const {
    return *std::find_if(
        selection.candidates.begin(), selection.candidates.end(),
        [&](const Candidate& one) { return with_twin_->model(one.fault).name().id == id; });
  }
  /// ln BF by which the twin lies behind.
  double Behind(const Selection& selection) const {
    return Find("cable_gain", selection).ln_bayes_factor - Find("twin", selection).ln_bayes_factor;
  }
  bool IsIndistinguishable(const Selection& selection) const {
    return std::any_of(
        selection.indistinguishable.begin(), selection.indistinguishable.end(),
        [&](const Candidate& one) { return with_twin_->model(one.fault).name().id == "twin"; });
  }

  std::unique_ptr<HypothesisSet> with_twin_;
};

TEST_F(SameEffect, IsNotToldApartByWhatIsBelievedBeforehand) {
  const Selection selection = Select(20.0);
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  EXPECT_EQ(with_twin_->model(selection.named[0].fault).name().id, "cable_gain");
  EXPECT_GT(Find("twin", selection).canonical_correlation, 0.99);
  ASSERT_GT(Behind(selection), 4.0) << "else it would be alike in any case";
  ASSERT_LT(Behind(selection), 9.0);
  EXPECT_TRUE(IsIndistinguishable(selection));
}

TEST_F(SameEffect, IsToldApartWhereThatIsClear) {
  const Selection selection = Select(2e5);
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  EXPECT_GT(Find("twin", selection).canonical_correlation, 0.99);
  ASSERT_GT(Behind(selection), 11.0);
  EXPECT_FALSE(IsIndistinguishable(selection));
}

}  // namespace
}  // namespace palpate::diagnosis
