// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/backward_check.hpp"

#include <gmock/gmock.h>

#include <random>

#include "components/diagnosis/causes/catalogue.hpp"
#include "tests/components/diagnosis_core/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kClearEvidence = 10.0;

/// SmallRobot with causes hidden in it, measured with 0.1 mm.
class BackwardCheck : public testing::Test {
 protected:
  /// z of the first parameter of the cause of this id at this place.
  struct Hidden {
    std::string id;
    std::string where;
    double z;
  };

  BackwardCheck()
      : body_(SmallRobot()),
        observed_(Observe(SmallExperiment(body_), body_, {.most_samples = 40})),
        book_(MakeCauses({.body = body_, .observed = observed_}, {}), {}) {
    observed_.sigma_m.setConstant(kSigma_m);
  }

  int Number(const std::string& id, const std::string& where) const {
    for (int k = 0; k < book_.size(); ++k) {
      if (book_.cause(k).name() == CauseName{id, {where}}) return k;
    }
    ADD_FAILURE() << "no " << id << " of " << where;
    return -1;
  }

  void Measure(const std::vector<Hidden>& hidden) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(book_.parameter_count());
    for (const Hidden& one : hidden) z[book_.first(Number(one.id, one.where))] = one.z;
    const Simulation truth =
        Simulator(observed_, 1).Run(DraftWith(DraftOf(body_, observed_), book_.All(), z));
    ASSERT_TRUE(truth.status.ok());
    std::mt19937 random(kSeed);
    std::normal_distribution<double> normal;
    for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
      Sample& sample = observed_.samples[s];
      sample.position_m = truth.samples[s].markers_m;
      for (Eigen::Index k = 0; k < sample.position_m.size(); ++k) {
        sample.position_m.reshaped()[k] +=
            kSigma_m / std::sqrt(sample.count[k / 3]) * normal(random);
      }
    }
  }

  /// As it would stand where these were named one after the other.
  Selection Named(const Fitter& fitter, const std::vector<int>& faults) const {
    Selection selection;
    selection.healthy = fitter.AsBuilt();
    selection.best = fitter.Complete(fitter.Refine(faults, selection.healthy));
    for (const int fault : faults) {
      Choice& choice = selection.named.emplace_back(Choice{.cause = fault});
      choice.ln_gain_of_recording.resize(observed_.recordings.size());
    }
    return selection;
  }

  static constexpr double kSigma_m = 1e-4;
  static constexpr unsigned kSeed = 3;
  robot::RobotBody body_;
  ObservedExperiment observed_;
  CauseBook book_;
};

TEST_F(BackwardCheck, ExchangesAWrongCauseForTheRightOneOnceAnotherIsKnown) {
  Measure({{"cable_gain", "cable:up", 0.1}, {"density", "body", 0.3}});
  const Fitter fitter(observed_, body_, book_, {}, 1);
  const int right = Number("cable_gain", "cable:up");
  const int other = Number("density", "body");
  Selection selection = Named(fitter, {Number("cable_offset", "cable:up"), other});
  const double before = selection.best.posterior.ln_evidence;
  CheckBackward(fitter, kClearEvidence, &selection);
  EXPECT_THAT(selection.best.faults, testing::UnorderedElementsAre(right, other))
      << "seed " << kSeed;
  ASSERT_EQ(selection.named.size(), 2U);
  EXPECT_EQ(selection.named[0].cause, right);
  EXPECT_GT(selection.named[0].probability, 0.9);
  EXPECT_GT(selection.best.posterior.ln_evidence, before + kClearEvidence);
}

TEST_F(BackwardCheck, DropsWhatTheOthersLeaveNoEvidenceFor) {
  Measure({{"cable_gain", "cable:up", 0.1}});
  const Fitter fitter(observed_, body_, book_, {}, 1);
  const int right = Number("cable_gain", "cable:up");
  Selection selection = Named(fitter, {Number("gravity_direction", "base"), right});
  CheckBackward(fitter, kClearEvidence, &selection);
  EXPECT_THAT(selection.best.faults, testing::ElementsAre(right)) << "seed " << kSeed;
  EXPECT_EQ(selection.named.size(), 1U);
}

TEST_F(BackwardCheck, KeepsWhatIsRight) {
  Measure({{"cable_gain", "cable:up", 0.1}, {"density", "body", 0.3}});
  const Fitter fitter(observed_, body_, book_, {}, 1);
  const std::vector<int> right{Number("cable_gain", "cable:up"), Number("density", "body")};
  Selection selection = Named(fitter, right);
  CheckBackward(fitter, kClearEvidence, &selection);
  EXPECT_EQ(selection.best.faults, right) << "seed " << kSeed;
}

}  // namespace
}  // namespace palpate::diagnosis
