// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/model_averaging.hpp"

#include <algorithm>
#include <cmath>

#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kGain = 0.1;
/// Three and a half tolerances of an actuator's zero: ln BF can be no more than half its square.
constexpr double kOffset_m = 1.05e-3;

class FurtherCausesOfAGain : public HiddenFaults {
 protected:
  int Gain() const { return Number("cable_gain", "cable:up"); }
  Fit WithGain(const Fitter& fitter) const {
    return fitter.WithAllFaults(fitter.Complete(fitter.Refine({Gain()}, fitter.AsBuilt())));
  }
  Eigen::MatrixXd Own(const Fit& fit) const {
    return fit.posterior.covariance.block(hypotheses_.first(Gain()), hypotheses_.first(Gain()), 1,
                                          1);
  }
  static double Sigma(const Eigen::MatrixXd& covariance) { return std::sqrt(covariance(0, 0)); }
};

TEST_F(FurtherCausesOfAGain, AreOfNoWeightWhereItExplainsAll) {
  Measure({{"cable_gain", "cable:up", kGain}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Fit fit = WithGain(fitter);
  ASSERT_TRUE(fit.status.ok());
  const Eigen::MatrixXd all =
      CovarianceOverFurtherFaults(hypotheses_, fit, Gain(), FurtherFaults(fitter, fit), Own(fit));
  EXPECT_NEAR(Sigma(all) / Sigma(Own(fit)), 1.0, 0.1) << "seed " << kSeed;
}

TEST_F(FurtherCausesOfAGain, OneThatIsNotClearWidensWhatIsKnownOfIt) {
  Measure({{"cable_gain", "cable:up", kGain}, {"cable_offset", "cable:up", kOffset_m}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Fit fit = WithGain(fitter);
  ASSERT_TRUE(fit.status.ok());
  const std::vector<FurtherFault> further = FurtherFaults(fitter, fit);
  const int offset = Number("cable_offset", "cable:up");
  const auto found = std::find_if(further.begin(), further.end(),
                                  [&](const FurtherFault& one) { return one.fault == offset; });
  ASSERT_NE(found, further.end()) << "seed " << kSeed;
  EXPECT_NEAR(found->posterior.mean[hypotheses_.first(offset)], kOffset_m, 0.3 * kOffset_m);
  const Eigen::MatrixXd all =
      CovarianceOverFurtherFaults(hypotheses_, fit, Gain(), further, Own(fit));
  EXPECT_GT(Sigma(all), 1.5 * Sigma(Own(fit))) << "seed " << kSeed;
}

TEST_F(FurtherCausesOfAGain, CountAsOftenAsTheyAreProbable) {
  Fit fit;
  fit.posterior.mean = Eigen::VectorXd::Constant(hypotheses_.parameter_count(), 1.0);
  FurtherFault other{.fault = Number("density", "body"), .weight = 0.5, .posterior = {}};
  other.posterior.mean = Eigen::VectorXd::Constant(hypotheses_.parameter_count(), 4.0);
  other.posterior.covariance =
      2.0 * Eigen::MatrixXd::Identity(hypotheses_.parameter_count(), hypotheses_.parameter_count());
  const Eigen::MatrixXd own = Eigen::MatrixXd::Identity(1, 1);
  EXPECT_EQ(CovarianceOverFurtherFaults(hypotheses_, fit, Gain(), {}, own), own);
  const double both = CovarianceOverFurtherFaults(hypotheses_, fit, Gain(), {other}, own)(0, 0);
  EXPECT_DOUBLE_EQ(both, (1.0 + 0.5 * (2.0 + 3.0 * 3.0)) / 1.5);
}

}  // namespace
}  // namespace palpate::diagnosis
