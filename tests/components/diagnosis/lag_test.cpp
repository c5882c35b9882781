// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <random>

#include "components/diagnosis/forward/sample_differentiator.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

class Lag : public HiddenFaults {
 protected:
  const FaultModel& lag() const { return hypotheses_.model(Number("lag", "body")); }

  /// What a fit to a robot that is late by 0.12 s says of it.
  std::vector<FittedParameter> FoundOf(double rounded) {
    Measure({{"lag", "body", 0.12, 0}, {"lag", "body", rounded, 1}});
    const Fitter fitter(observed_, body_, hypotheses_, {.relative_error = 1e-6}, 1);
    const int number = Number("lag", "body");
    const Fit fit = fitter.Complete(fitter.Refine({number}, fitter.AsBuilt()));
    EXPECT_TRUE(fit.status.ok()) << fit.status.message();
    const Eigen::Index first = hypotheses_.first(number);
    return lag().Report(fit.posterior.mean.segment<2>(first),
                        fit.posterior.covariance.block<2, 2>(first, first), {});
  }
};

/// Together they are known to some 8 ms (one sigma), whichever it is.
void ExpectKnownTogether(const std::vector<FittedParameter>& found) {
  EXPECT_NEAR(found[0].value + found[1].value, 0.12, 3.0 * 0.008);
  for (const FittedParameter& part : found) EXPECT_LT(part.ci95_high, 0.15) << part.name;
}

void ExpectInside(const FittedParameter& found, double hidden) {
  EXPECT_LE(found.ci95_low, hidden + 1e-9) << found.name;
  EXPECT_GE(found.ci95_high, hidden - 1e-9) << found.name;
}

TEST_F(Lag, IsADelayAndATimeConstant) {
  const Eigen::Vector2d z(0.1, 0.3);
  ModelHypothesis hypothesis = NominalHypothesis(body_, observed_);
  lag().Apply(z, &hypothesis);
  EXPECT_NEAR(hypothesis.actuators.delay_s + hypothesis.actuators.tau_s, 0.1, 1e-12);
  EXPECT_NEAR(hypothesis.actuators.tau_s * hypothesis.actuators.tau_s, 0.8 * 0.1 * 0.1, 1e-12);
  const auto report = lag().Report(z, 1e-12 * Eigen::Matrix2d::Identity(), {});
  ASSERT_EQ(report.size(), 2U);
  EXPECT_EQ(report[0].name, "delay_s");
  EXPECT_EQ(report[1].name, "tau_s");
  EXPECT_NEAR(report[0].value, hypothesis.actuators.delay_s, 1e-12);
  EXPECT_NEAR(report[1].value, hypothesis.actuators.tau_s, 1e-12);
  for (const FittedParameter& part : report) {
    EXPECT_NEAR(part.ci95_low, part.value, 1e-5);
    EXPECT_NEAR(part.ci95_high, part.value, 1e-5);
  }
}

TEST_F(Lag, HasIntervalsOfAsMuchAsIsBelieved) {
  constexpr int kDraws = 20000;
  const Eigen::Vector2d z(0.15, 0.1);
  Eigen::Matrix2d root;
  root << 0.01, 0.0, -0.05, 0.15;
  const auto report = lag().Report(z, root * root.transpose(), {});
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  Eigen::Array2i below(0, 0);
  Eigen::Array2i above(0, 0);
  for (int k = 0; k < kDraws; ++k) {
    const double first = normal(random);
    const double second = normal(random);
    ModelHypothesis hypothesis = NominalHypothesis(body_, observed_);
    lag().Apply(z + root * Eigen::Vector2d(first, second), &hypothesis);
    const double part_s[] = {hypothesis.actuators.delay_s, hypothesis.actuators.tau_s};
    for (std::size_t p = 0; p < 2; ++p) {
      below[static_cast<Eigen::Index>(p)] += part_s[p] < report[p].ci95_low;
      above[static_cast<Eigen::Index>(p)] += part_s[p] > report[p].ci95_high;
    }
  }
  // 2.5 % give or take five sigma of what so many draws scatter by.
  const double wanted = 0.025 * kDraws;
  const double scatter = 5.0 * std::sqrt(wanted);
  for (Eigen::Index p = 0; p < 2; ++p) {
    EXPECT_NEAR(below[p], wanted, scatter) << "seed " << kSeed;
    EXPECT_NEAR(above[p], wanted, scatter) << "seed " << kSeed;
  }
}

TEST_F(Lag, HasADerivativeWhereAllOfItIsATimeConstant) {
  const auto change_at = [&](double rounded) {
    const FaultModelList one{&lag()};
    const Eigen::VectorXd z = Eigen::Vector2d(0.12, rounded);
    const ModelHypothesis nominal = NominalHypothesis(body_, observed_);
    return ActuatorChanges(ActuatorChain(observed_), nominal, one, z, {true},
                           HypothesisWith(nominal, one, z).actuators)[1];
  };
  const Eigen::MatrixXd inside = change_at(0.499);
  EXPECT_GT(inside.norm(), 0.0);
  EXPECT_LT((change_at(0.5) - inside).norm(), 0.01 * inside.norm());
}

TEST_F(Lag, OfATimeConstantIsFoundInsideOfItsIntervals) {
  const auto found = FoundOf(0.5);
  ExpectKnownTogether(found);
  ExpectInside(found[0], 0.0);
  ExpectInside(found[1], 0.12);
}

TEST_F(Lag, OfADelayIsFoundInsideOfItsIntervals) {
  const auto found = FoundOf(-0.5);
  ExpectKnownTogether(found);
  ExpectInside(found[0], 0.12);
  ExpectInside(found[1], 0.0);
}

}  // namespace
}  // namespace palpate::diagnosis
