// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kGain = 0.1;

/// What a gain does, as something of which no robot has so much.
class GainInDisguise final : public FaultModel {
 public:
  explicit GainInDisguise(int number)
      : FaultModel({"disguise", {std::to_string(number)}}, "a gain in disguise",
                   {{.name = "z",
                     .tolerance = 0.001,
                     .fault = 0.02,
                     .fault_at = kGain,
                     .plausible = 0.05}}) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.gain[0] += z[0];
  }
};

/// Promises what a gain does, and does no more than a part of it.
class Boaster final : public FaultModel {
 public:
  explicit Boaster(int number)
      : FaultModel({"boaster", {std::to_string(number)}}, "a boaster",
                   {{.name = "z", .tolerance = 0.001, .fault = 0.02, .fault_at = kGain}}) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.gain[0] += std::min(z[0], 0.2 * kGain);
  }
};

/// Promises less than it does.
class Understater final : public FaultModel {
 public:
  explicit Understater(int number)
      : FaultModel({"understater", {std::to_string(number)}}, "an understater",
                   {{.name = "z", .tolerance = 0.001, .fault = 0.015}}) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.gain[0] += z[0] + z[0] * std::abs(z[0]) / (0.5 * kGain);
  }
};

class RuledOut : public HiddenFaults {
 protected:
  static std::vector<std::string> AllButGains() {
    std::vector<std::string> ids = CatalogueIds();
    std::erase(ids, "cable_gain");
    return ids;
  }
  /// With so many faults of this class beside the real ones.
  template <class Other>
  Selection Select(int others, const std::vector<std::string>& without, TimeLimit limit = {}) {
    Measure({{"cable_gain", "cable:up", kGain}});
    std::vector<FaultModelPtr> causes = Causes(without);
    for (int k = 0; k < others; ++k) causes.push_back(std::make_unique<Other>(k));
    with_others_ =
        std::make_unique<HypothesisSet>(std::move(causes), std::map<std::string, double>());
    const Fitter fitter(observed_, body_, *with_others_, {}, 1, limit);
    return SelectFaults(observed_, fitter, fitter.AsBuilt(), 1, [](int, int, const auto&) {});
  }
  std::string IdOf(int cause) const { return with_others_->model(cause).name().id; }

  std::unique_ptr<HypothesisSet> with_others_;
};

/// However many are simulated first in vain.
TEST_F(RuledOut, CausesMakeRoomForTheNextOnes) {
  const Selection selection = Select<GainInDisguise>(6, {});
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  EXPECT_EQ(IdOf(selection.named[0].fault), "cable_gain");
  EXPECT_GT(selection.named[0].probability, 0.9) << "what was ruled out is no rival";
  // Cable `up` is pulled most, so its couplings have nearly the effect of its gain.
  for (const Candidate& one : selection.indistinguishable) {
    EXPECT_EQ(IdOf(one.fault), "drive_coupling") << with_others_->model(one.fault).words();
    EXPECT_GT(one.canonical_correlation, kSelectionTuning.same_effect);
    EXPECT_FALSE(one.ruled_out);
  }
}

/// These explain enough to be named, if none promised more.
TEST_F(RuledOut, OrSurpassedByWhatAnotherPromises) {
  const Selection selection = Select<Boaster>(4, AllButGains());
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  EXPECT_EQ(IdOf(selection.named[0].fault), "cable_gain");
}

/// What one gains on its guess is nothing against the guess of another.
TEST_F(RuledOut, AreNoneByAGuess) {
  const Selection selection = Select<Understater>(2, CatalogueIds());
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  ASSERT_EQ(selection.indistinguishable.size(), 1U);
  EXPECT_EQ(IdOf(selection.indistinguishable[0].fault), "understater");
  EXPECT_TRUE(selection.indistinguishable[0].refined);
  const Candidate& first = selection.candidates.front();
  EXPECT_GT(first.ln_bayes_factor, first.ln_screened + 10.0) << "else the test shows nothing";
}

TEST_F(RuledOut, AreNotNamedWhereThereIsNoTimeToSeeWhatAnotherPromises) {
  const Selection selection = Select<Boaster>(4, AllButGains(), TimeLimit(1e-9));
  EXPECT_TRUE(selection.named.empty());
  EXPECT_FALSE(selection.complete);
  ASSERT_FALSE(selection.candidates.empty());
  EXPECT_EQ(IdOf(selection.candidates.front().fault), "boaster");
  EXPECT_TRUE(selection.candidates.front().refined);
  EXPECT_THAT(selection.candidates.front().why_not, testing::HasSubstr("was not simulated"));
}

}  // namespace
}  // namespace palpate::diagnosis
