// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <string>

#include "components/diagnosis/forward/simulator.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

/// Simulations that begin from one of a robot that was a little different.
class NearStart : public HiddenFaults {
 protected:
  ModelHypothesis HypothesisOfOne(const std::string& id, const std::string& where, double z) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(hypotheses_.parameter_count());
    all[ColumnOf(id, where)] = z;
    return HypothesisWith(NominalHypothesis(body_, observed_), hypotheses_.All(), all);
  }
  static double Apart_m(const Simulation& a, const Simulation& b) {
    double most_m = 0.0;
    for (std::size_t s = 0; s < a.samples.size(); ++s) {
      most_m = std::max(
          most_m, (a.samples[s].markers_m() - b.samples[s].markers_m()).cwiseAbs().maxCoeff());
    }
    return most_m;
  }
  static int Choices(const Simulation& simulation) {
    int choices = 0;
    for (const SimulatedSample& sample : simulation.samples) choices += sample.choices;
    return choices;
  }

  Simulator simulator_{observed_, 1};
  Simulation as_built_ = simulator_.Run(NominalHypothesis(body_, observed_));
};

TEST_F(NearStart, LeadsToWhereARobotThatRemembersIsFromNothing) {
  constexpr double kSettled = 0.02;  // of the effect; sweeps end before all is
  for (const auto& [id, z] : {std::pair("viscoelastic_creep", 0.3), std::pair("mullins", 0.4)}) {
    const ModelHypothesis hypothesis = HypothesisOfOne(id, "body", z);
    const Simulation from_nothing = simulator_.Run(hypothesis);
    const Simulation from_near = simulator_.Run(hypothesis, &as_built_, Detail::kAllParts);
    ASSERT_TRUE(from_nothing.status.ok() && from_near.status.ok()) << id;
    const double effect_m = Apart_m(from_nothing, as_built_);
    EXPECT_GT(effect_m, 1e-4) << id;
    EXPECT_LT(Apart_m(from_nothing, from_near), kSettled * effect_m) << id;
  }
}

TEST_F(NearStart, ForgetsAPastThatTheRobotHasNot) {
  const Simulation crept = simulator_.Run(HypothesisOfOne("viscoelastic_creep", "body", 0.3));
  const Simulation again =
      simulator_.Run(NominalHypothesis(body_, observed_), &crept, Detail::kAllParts);
  EXPECT_LT(Apart_m(again, as_built_), 1e-9);
}

TEST_F(NearStart, KeepsTheShapesOfAMotionAndTheirMean) {
  const ModelHypothesis hypothesis = HypothesisOfOne("youngs_modulus", "body", 0.02);
  const Simulation whole = simulator_.Run(hypothesis, &as_built_, Detail::kAllParts);
  const Simulation kept = simulator_.Run(hypothesis, &as_built_);
  EXPECT_EQ(Choices(whole), 2 * Choices(as_built_));
  EXPECT_LT(Choices(kept), Choices(whole));
  const double effect_m = Apart_m(whole, as_built_);
  EXPECT_GT(effect_m, 1e-5);
  EXPECT_LT(Apart_m(whole, kept), 0.1 * effect_m);
}

/// What nothing is known of begins, as one that was near, with the first sample that fails.
TEST_F(NearStart, EndsWithTheFirstMomentWithoutABalance) {
  ModelHypothesis hypothesis = NominalHypothesis(body_, observed_);
  hypothesis.body.gravity_m_s2 *= 1e4;
  const Simulation nothing;
  const Simulation ended = simulator_.Run(hypothesis, &nothing);
  EXPECT_FALSE(ended.status.ok());
  const std::string left_out = "another sample could not be simulated";
  std::size_t tried = 0;
  for (const SimulatedSample& sample : ended.samples) {
    EXPECT_FALSE(sample.status.ok());
    tried += sample.status.message() != left_out ? 1 : 0;
  }
  EXPECT_EQ(tried, 1U);
  EXPECT_GT(ended.samples.size(), 1U);
}

}  // namespace
}  // namespace palpate::diagnosis
