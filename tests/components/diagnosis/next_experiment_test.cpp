// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/next_experiment.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "components/diagnosis/faults/catalogue.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

using experiment::RecordingKind;

/// A small robot that was pulled up and aside and has a fault, measured without noise; the prior of
/// it is one of two faults.
class NextExperiment : public testing::Test {
 protected:
  NextExperiment() : body_(SmallRobot()) {
    experiment_.markers_sigma_m = Eigen::Vector3d::Constant(3e-4);
    experiment_.rest_between_s = 4.0;
    experiment_.recordings = {
        MakeRecording("a_ramp", body_, {{0.0, {0, 0, 0}}, {4.0, {0.007, 0, 0}}, {8.0, {0, 0, 0}}},
                      0.2),
        MakeRecording("b_ramp", body_,
                      {{12.0, {0, 0, 0}}, {16.0, {0, 0.006, 0}}, {20.0, {0, 0, 0}}}, 0.2)};
  }

  int NumberOf(const std::string& id, std::size_t nth = 0) const {
    for (int k = 0; k < hypotheses_->size(); ++k) {
      if (hypotheses_->model(k).name().id == id && nth-- == 0) return k;
    }
    ADD_FAILURE() << id;
    return 0;
  }

  /// Proposals that are to tell the first fault, hidden with z in its first parameter, from the
  /// second.
  std::vector<RankedProposal> Rank(const std::string& hidden, double z, const std::string& rival,
                                   std::size_t nth = 0) {
    observed_ = Observe(experiment_, body_);
    hypotheses_ =
        std::make_unique<HypothesisSet>(MakeFaultModels({.body = body_, .observed = observed_}, {}),
                                        std::map<std::string, double>{});
    const int a = NumberOf(hidden, nth);
    const Eigen::VectorXd own = z * Eigen::VectorXd::Unit(hypotheses_->count(a), 0);
    const Simulation truth = Simulator(observed_, 1)
                                 .Run(HypothesisWith(NominalHypothesis(body_, observed_),
                                                     {&hypotheses_->model(a)}, own));
    EXPECT_TRUE(truth.status.ok()) << truth.status.message();
    for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
      observed_.samples[s].position_m = truth.samples[s].markers_m();
    }
    fitter_ = std::make_unique<Fitter>(observed_, body_, *hypotheses_, NoiseModel{}, 1);
    selection_.null_model = fitter_->AsBuilt();
    selection_.best = fitter_->Complete(fitter_->Refine({a}, selection_.null_model));
    EXPECT_TRUE(selection_.best.status.ok());
    selection_.named = {{.fault = a, .ln_bayes_factor = 20.0}};
    selection_.indistinguishable = {{.fault = NumberOf(rival), .ln_bayes_factor = 18.0}};
    return RankAgain();
  }

  std::vector<RankedProposal> RankAgain() {
    question_ = QuestionOf(*fitter_, selection_);
    return RankProposals(experiment_, observed_, body_, *fitter_, selection_, question_, 1);
  }

  /// A nominal robot where there is some evidence for these, of a hundred faults: those with ln BF
  /// 4.6 and more are likelier than none.
  void NameNone(std::vector<Candidate> candidates) {
    selection_.named.clear();
    selection_.indistinguishable.clear();
    selection_.best = selection_.null_model;
    selection_.candidates = std::move(candidates);
    selection_.candidates.resize(100);
  }

  static RecordingKind KindOf(const RankedProposal& one) { return one.proposal.recording.kind; }
  static bool HasWeight(const RankedProposal& one) { return one.proposal.weight.has_value(); }
  static bool IsTilted(const RankedProposal& one) {
    return one.proposal.recording.base_tilt_deg.has_value();
  }
  /// What is expected of the best one that is not such.
  static double BestBut(const std::vector<RankedProposal>& ranked,
                        bool (*such)(const RankedProposal&)) {
    const auto best = std::find_if_not(ranked.begin(), ranked.end(), such);
    if (best != ranked.end()) return best->expected_ln_bayes_factor;
    ADD_FAILURE() << "all are such";
    return 0.0;
  }
  static std::string Commanded(const std::vector<RankedProposal>& ranked) {
    std::string text;
    for (const RankedProposal& one : ranked) {
      text += one.proposal.title + ": " + std::to_string(one.expected_ln_bayes_factor) + ", " +
              std::to_string(one.information) + "\n";
    }
    return text;
  }

  robot::RobotBody body_;
  experiment::Experiment experiment_;
  ObservedExperiment observed_;
  std::unique_ptr<HypothesisSet> hypotheses_;
  std::unique_ptr<Fitter> fitter_;
  Selection selection_;
  Question question_;
};

TEST_F(NextExperiment, TellsAModulusFromADensityByAKnownWeight) {
  const auto ranked = Rank("youngs_modulus", 0.2, "density");
  ASSERT_GT(ranked.size(), 2U);
  EXPECT_TRUE(HasWeight(ranked[0])) << Commanded(ranked);
  EXPECT_TRUE(HasWeight(ranked[1])) << Commanded(ranked);
  // Neither pulls nor tilts tell the two factors of rho g / E apart.
  EXPECT_GT(ranked[0].expected_ln_bayes_factor, 3.0 * BestBut(ranked, HasWeight))
      << Commanded(ranked);
}

TEST_F(NextExperiment, TellsAMassFromABentShapeByATilt) {
  const auto ranked = Rank("payload", 2e-3, "plastic_set");
  ASSERT_FALSE(ranked.empty());
  EXPECT_TRUE(IsTilted(ranked[0])) << Commanded(ranked);
  EXPECT_GT(ranked[0].expected_ln_bayes_factor, 3.0 * BestBut(ranked, IsTilted))
      << Commanded(ranked);
}

/// Both turn with gravity; only what these data leave open of the force's direction can tell.
TEST_F(NextExperiment, HasLittleAgainstAForceThatPullsAsAMassDoes) {
  const auto ranked = Rank("payload", 2e-3, "permanent_force");
  ASSERT_FALSE(ranked.empty());
  EXPECT_EQ(KindOf(ranked[0]), RecordingKind::kBaseTilted) << Commanded(ranked);
  EXPECT_LT(ranked[0].expected_ln_bayes_factor, 1.0) << Commanded(ranked);
}

TEST_F(NextExperiment, TellsCreepFromFrictionAndFromLagByAHold) {
  constexpr std::size_t kHalfAMinute = 3;
  for (const char* rival : {"cable_friction", "lag"}) {
    const auto ranked = Rank("viscoelastic_creep", 0.2, rival, kHalfAMinute);
    ASSERT_FALSE(ranked.empty());
    EXPECT_EQ(KindOf(ranked[0]), RecordingKind::kHold) << rival << "\n" << Commanded(ranked);
  }
}

TEST_F(NextExperiment, IsWhatSeparatesTheWorstRivalBest) {
  const auto of_titles = [](const std::vector<RankedProposal>& ranked) {
    std::map<std::string, double> expected;
    for (const RankedProposal& one : ranked) {
      expected[one.proposal.title] = one.expected_ln_bayes_factor;
    }
    return expected;
  };
  const auto bent = of_titles(Rank("payload", 2e-3, "plastic_set"));
  const Candidate force{.fault = NumberOf("permanent_force"), .ln_bayes_factor = 18.0};
  selection_.indistinguishable.push_back(force);
  const std::vector<RankedProposal> both = RankAgain();
  selection_.indistinguishable = {force};
  const auto pulled = of_titles(RankAgain());
  ASSERT_EQ(both.size(), bent.size());
  for (std::size_t k = 0; k < both.size(); ++k) {
    const std::string& title = both[k].proposal.title;
    const bool is_bent = bent.at(title) < pulled.at(title);
    EXPECT_NEAR(both[k].expected_ln_bayes_factor, std::min(bent.at(title), pulled.at(title)), 1e-9);
    EXPECT_EQ(both[k].worst_rival.id, is_bent ? "plastic_set" : "permanent_force") << title;
    if (k == 0) continue;
    EXPECT_LT(both[k].expected_ln_bayes_factor, both[k - 1].expected_ln_bayes_factor + 0.1);
  }
  const std::vector<ExperimentProposal> described = Describe(question_, both);
  EXPECT_EQ(described.size(), both.size());
  EXPECT_EQ(described.front().title, both.front().proposal.title);
  EXPECT_EQ(described.front().first.id, "payload");
  EXPECT_EQ(described.front().second, both.front().worst_rival);
}

TEST_F(NextExperiment, IsNoneWhereNothingIsInQuestion) {
  Rank("payload", 2e-3, "plastic_set");
  selection_.indistinguishable.clear();
  selection_.candidates = {{.fault = selection_.named.front().fault, .ln_bayes_factor = 20.0},
                           {.fault = NumberOf("density"), .ln_bayes_factor = 9.9}};
  EXPECT_TRUE(RankAgain().empty());
  selection_.candidates.back().ln_bayes_factor = 10.1;
  ASSERT_FALSE(RankAgain().empty());
  EXPECT_EQ(question_.rivals.front().name.id, "density");
}

TEST_F(NextExperiment, OfAHealthyRobotAsksForWhatHasSomeEvidence) {
  Rank("payload", 2e-3, "plastic_set");
  NameNone({{.fault = NumberOf("density"), .ln_bayes_factor = 4.0},
            {.fault = NumberOf("lag"), .ln_bayes_factor = 2.0}});
  selection_.goodness_of_fit.passed = false;
  EXPECT_TRUE(RankAgain().empty());
  selection_.goodness_of_fit.passed = true;
  ASSERT_FALSE(RankAgain().empty());
  EXPECT_EQ(question_.best.name.id, "no_fault");
  ASSERT_EQ(question_.rivals.size(), 1U);
  EXPECT_EQ(question_.rivals.front().name.id, "density");
}

/// No tilt separates these two, however well it separates either from none.
TEST_F(NextExperiment, WhereAFaultIsLikelierThanNoneAsksForWhichOfThem) {
  Rank("payload", 2e-3, "plastic_set");
  NameNone({{.fault = NumberOf("density"), .ln_bayes_factor = 8.0},
            {.fault = NumberOf("youngs_modulus"), .ln_bayes_factor = 9.0},
            {.fault = NumberOf("lag"), .ln_bayes_factor = 9.5, .ruled_out = true}});
  selection_.goodness_of_fit.passed = true;
  const std::vector<RankedProposal> ranked = RankAgain();
  EXPECT_EQ(question_.best.name.id, "youngs_modulus");
  std::vector<std::string> rivals;
  for (const Hypothesis& rival : question_.rivals) rivals.push_back(rival.name.id);
  EXPECT_THAT(rivals, testing::UnorderedElementsAre("no_fault", "density"));
  ASSERT_FALSE(ranked.empty());
  EXPECT_TRUE(HasWeight(ranked.front())) << Commanded(ranked);
}

}  // namespace
}  // namespace palpate::diagnosis
