// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/fitter.hpp"

#include "components/diagnosis/inference/forward_selection.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

/// Nothing bends it at rest, where its cables are between slack and taut.
robot::RobotBody WeightlessRobot() {
  robot::RobotBody body = SmallRobot();
  body.gravity_m_s2.setZero();
  return body;
}

experiment::Experiment RestsAndRamps() {
  const robot::RobotBody body = WeightlessRobot();
  const std::vector<double> zero{0.0, 0.0, 0.0};
  const std::vector<double> aside{0.0, 0.006, 0.0};
  const std::vector<double> down{0.0, 0.0, 0.006};
  experiment::Experiment experiment;
  experiment.markers_sigma_m = Eigen::Vector3d::Constant(1e-4);
  experiment.rest_between_s = 4.0;
  experiment.recordings = {
      MakeRecording("a_rest", body, {{0.0, zero}, {4.0, zero}}, 0.1),
      MakeRecording("b_aside", body, {{8.0, zero}, {12.0, aside}, {16.0, zero}}, 0.1),
      MakeRecording("c_down", body, {{20.0, zero}, {24.0, down}, {28.0, zero}}, 0.1),
      MakeRecording("d_rest", body, {{32.0, zero}, {36.0, zero}}, 0.1)};
  return experiment;
}

class FitterOfHealthyRobots : public HiddenFaults {
 protected:
  FitterOfHealthyRobots() : HiddenFaults(WeightlessRobot(), RestsAndRamps()) {}

  /// Root mean square over the noise of what a simulation leaves of the data.
  double LeftBy(const Simulation& simulation) const {
    double sum = 0.0;
    Eigen::Index count = 0;
    for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
      const Sample& sample = observed_.samples[s];
      const Eigen::Matrix3Xd left_m = sample.position_m - simulation.samples[s].markers_m();
      sum += (left_m * sample.count.cast<double>().asDiagonal()).cwiseProduct(left_m).sum();
      count += left_m.size();
    }
    return std::sqrt(sum / static_cast<double>(count)) / kSigma_m;
  }
  /// The same of the robot that a fit takes for the most probable.
  double LeftBy(const Fit& fit) const {
    Eigen::VectorXd z = fit.posterior.mean;
    for (int k = 0; k < hypotheses_.size(); ++k) {
      for (Eigen::Index p = 0; p < hypotheses_.count(k); ++p) {
        const double least = hypotheses_.model(k).parameters()[static_cast<std::size_t>(p)].least;
        z[hypotheses_.first(k) + p] = std::max(least, z[hypotheses_.first(k) + p]);
      }
    }
    const ModelHypothesis hypothesis =
        HypothesisWith(NominalHypothesis(body_, observed_), hypotheses_.All(), z);
    return LeftBy(Simulator(observed_, 1).Run(hypothesis));
  }
};

/// The more the larger the fault is: faster than its size.
TEST_F(FitterOfHealthyRobots, TellHowFarTheLinearModelWasOff) {
  const auto surprise = [&](double gain) {
    Measure({{"cable_gain", "cable:aside", gain}});
    const Fitter fitter(observed_, body_, hypotheses_, {.relative_error = 1e-6}, 1);
    const Fit as_built = fitter.AsBuilt();
    EXPECT_FALSE(fitter.IsStretched(as_built));
    const Fit fit = fitter.Refine({Number("cable_gain", "cable:aside")}, as_built);
    EXPECT_TRUE(fit.status.ok()) << fit.status.message();
    return fit.ln_surprise;
  };
  const double of_small = surprise(0.05);
  const double of_large = surprise(0.4);
  EXPECT_GT(of_large, 10.0 * of_small);
  EXPECT_GT(of_large, kSelectionTuning.refined_within);
}

TEST_F(FitterOfHealthyRobots, AreStretchedWhereTolerancesTakeAFault) {
  Measure({{"cable_gain", "cable:aside", 0.3}});
  const Fitter fitter(observed_, body_, hypotheses_, {.relative_error = 1e-6}, 1);
  EXPECT_TRUE(fitter.IsStretched(fitter.Complete(fitter.AsBuilt())));
}

TEST_F(FitterOfHealthyRobots, GoOnUntilTheDataFitAsPromised) {
  // Two tolerances, with which the cable pulls at rest.
  Measure({{"cable_offset", "cable:aside", 6e-4}});
  // The data are of the very mesh.
  const Fitter fitter(observed_, body_, hypotheses_, {.relative_error = 1e-6}, 1);
  const Fit as_built = fitter.AsBuilt();
  const Fit fit = fitter.Complete(as_built);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  EXPECT_TRUE(fit.complete);
  EXPECT_GT(LeftBy(as_built), 1.3) << "seed " << kSeed;
  EXPECT_LT(LeftBy(fit), 1.1) << "seed " << kSeed;
}

/// A fit with a fault is of what has an effect beside it, until more is asked for.
TEST_F(FitterOfHealthyRobots, DifferentiateByEveryFaultWhenAsked) {
  Measure({{"cable_gain", "cable:aside", 0.2}});
  const Fitter fitter(observed_, body_, hypotheses_, {.relative_error = 1e-6}, 1);
  const int gain = Number("cable_gain", "cable:aside");
  const Fit fit = fitter.Complete(fitter.Refine({gain}, fitter.AsBuilt()));
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  EXPECT_FALSE(fit.of_all_faults);
  const Fit all = fitter.WithAllFaults(fit);
  EXPECT_TRUE(all.of_all_faults);
  EXPECT_NEAR(all.posterior.ln_evidence, fit.posterior.ln_evidence, 1e-6);
  Simulation anew = fit.simulation;
  const ModelHypothesis nominal = NominalHypothesis(body_, observed_);
  const FaultModelList models = hypotheses_.All();
  Simulator(observed_, 1)
      .Differentiate(HypothesisWith(nominal, models, fit.z), models, fit.z,
                     std::vector<bool>(models.size(), true), nominal, &anew);
  double left = 0.0;
  for (std::size_t s = 0; s < anew.samples.size(); ++s) {
    const Eigen::MatrixXd& expected_m = anew.samples[s].jacobian_m;
    EXPECT_TRUE(all.simulation.samples[s].jacobian_m.isApprox(expected_m, 1e-12)) << "sample " << s;
    left += (fit.simulation.samples[s].jacobian_m - expected_m).norm() / expected_m.norm();
  }
  EXPECT_GT(left, 1e-3) << "there is nothing to ask for";
}

TEST_F(FitterOfHealthyRobots, SimulatePlayThatIsBeyondItsTolerance) {
  constexpr double kPlay_m = 2e-3;  // twenty tolerances
  Measure({{"backlash", "cable:aside", kPlay_m}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Fit fit = fitter.Complete(fitter.AsBuilt());
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  EXPECT_NEAR(fit.z[ColumnOf("backlash", "cable:aside")], kPlay_m, 3e-4) << "seed " << kSeed;
}

TEST_F(FitterOfHealthyRobots, KeepPlayWithinItsToleranceLinear) {
  Measure({{"backlash", "cable:aside", 1e-4}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Fit fit = fitter.Complete(fitter.AsBuilt());
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const Eigen::Index play = ColumnOf("backlash", "cable:aside");
  EXPECT_EQ(fit.z[play], 0.0);
  EXPECT_NEAR(fit.posterior.mean[play], 1e-4, 1e-4) << "seed " << kSeed;
}

}  // namespace
}  // namespace palpate::diagnosis
