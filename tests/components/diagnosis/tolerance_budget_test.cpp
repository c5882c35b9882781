// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <limits>

#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

/// Proof that the tolerance budget is what keeps nominal robots from being accused: the same
/// robots, built within their tolerances, before a judge that knows of these and one that does not.
class ToleranceBudget : public HiddenFaults {
 protected:
  static constexpr int kRobots = 20;
  static constexpr double kClearEvidence = 10.0;

  /// The same faults, all parts as exact as the robot file.
  HypothesisSet BookWithoutTolerances() const {
    constexpr double kExact = 1e-9;  // of any unit: nothing moves by so little
    std::map<std::string, double> exact;
    for (int k = 0; k < hypotheses_.size(); ++k) exact[hypotheses_.model(k).name().id] = kExact;
    return {Causes(), exact};
  }

  /// ln BF of the fault that looks most like what was measured.
  static double MostAccusing(const HypothesisSet& hypotheses, const Information& data) {
    const double null_model = hypotheses.InferWithin(data, {}).ln_evidence;
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < hypotheses.size(); ++k) {
      if (!hypotheses.CanBeFault(k)) continue;
      most = std::max(most, hypotheses.InferWithin(data, {k}).ln_evidence - null_model);
    }
    return most;
  }

  /// Healthy robots, measured.
  std::vector<Information> HealthyRobots() {
    Measure({});
    const LinearModel model = Fitter(observed_, body_, hypotheses_, {}, 1).AsBuilt().model;
    const GaussianPrior null_model = hypotheses_.PriorWith({});
    std::mt19937 random(kSeed);
    std::normal_distribution<double> normal;
    std::vector<Information> robots;
    for (int r = 0; r < kRobots; ++r) {
      Eigen::VectorXd y =
          Eigen::VectorXd::NullaryExpr(model.J.rows(), [&] { return normal(random); });
      for (Eigen::Index p = 0; p < null_model.sigma.size(); ++p) {
        y += null_model.sigma[p] * normal(random) * model.J.col(p);
      }
      Information& data = robots.emplace_back(model.J.cols());
      data.H.noalias() = model.J.transpose() * model.J;
      data.b.noalias() = model.J.transpose() * y;
      data.c = y.squaredNorm();
    }
    return robots;
  }
};

TEST_F(ToleranceBudget, KeepsHealthyRobotsFromBeingAccused) {
  const HypothesisSet without = BookWithoutTolerances();
  ASSERT_EQ(without.parameter_count(), hypotheses_.parameter_count());
  int accused = 0;
  int accused_without = 0;
  for (const Information& robot : HealthyRobots()) {
    accused += MostAccusing(hypotheses_, robot) > kClearEvidence;
    accused_without += MostAccusing(without, robot) > kClearEvidence;
  }
  EXPECT_LE(accused, kRobots / 20) << "seed " << kSeed;
  EXPECT_GE(accused_without, kRobots / 2) << "seed " << kSeed;
}

}  // namespace
}  // namespace palpate::diagnosis
