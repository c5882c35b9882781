// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/nearest_robot.hpp"

#include "components/diagnosis/faults/makers.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

/// Each cable pulled by itself, the others a little.
experiment::Experiment OneAfterTheOther() {
  const robot::RobotBody body = SmallRobot();
  experiment::Experiment experiment;
  for (std::size_t c = 0; c < body.cables.size(); ++c) {
    std::vector<double> pulled(body.cables.size(), 0.001);
    pulled[c] = 0.006;
    const double begin_s = 10.0 * static_cast<double>(c);
    experiment.recordings.push_back(MakeRecording(
        "r" + std::to_string(c), body, {{begin_s, pulled}, {begin_s + 1.0, pulled}}, 0.25));
  }
  return experiment;
}

class ExchangedCables : public HiddenFaults {
 protected:
  ExchangedCables() : HiddenFaults(SmallRobot(), OneAfterTheOther()) {
    MakeSwappedCables({.body = body_, .observed = observed_}, &exchanges_);
  }

  std::optional<CauseName> Found() const {
    const std::optional<LikelyFault> fault = FindNearestRobot(body_, observed_, 1, nullptr).fault;
    return fault ? std::optional(fault->name) : std::nullopt;
  }

  std::vector<FaultModelPtr> exchanges_;
};

TEST_F(ExchangedCables, AreFoundWhicheverTheyAre) {
  ASSERT_EQ(exchanges_.size(), 3u);
  for (const FaultModelPtr& exchange : exchanges_) {
    ModelHypothesis hypothesis = NominalHypothesis(body_, observed_);
    exchange->Apply(Eigen::VectorXd::Ones(1), &hypothesis);
    const Simulation truth = Simulator(observed_, 1).Run(hypothesis);
    for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
      observed_.samples[s].position_m = truth.samples[s].markers_m();
    }
    EXPECT_EQ(Found(), exchange->name()) << exchange->words();
  }
}

TEST_F(ExchangedCables, AreNotTakenForOtherFaults) {
  Measure({});
  EXPECT_EQ(Found(), std::nullopt);
  Measure({{"cable_gain", "cable:up", 0.15}, {"youngs_modulus", "body", -0.5}});
  EXPECT_EQ(Found(), std::nullopt);
  Measure({{"cable_offset", "cable:aside", 0.004}});
  EXPECT_EQ(Found(), std::nullopt);
}

/// Where all cables are pulled alike an exchange changes nothing.
TEST_F(ExchangedCables, AreNotGuessedWhereNothingTells) {
  for (Eigen::VectorXd& command : observed_.timeline.command) command.setConstant(0.004);
  Measure({});
  EXPECT_EQ(Found(), std::nullopt);
}

TEST_F(ExchangedCables, AreNotGuessedWhereNobodySawTheRobot) {
  for (Sample& sample : observed_.samples) sample.count.setZero();
  EXPECT_EQ(Found(), std::nullopt);
}

}  // namespace
}  // namespace palpate::diagnosis
