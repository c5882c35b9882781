// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/model_averaging.hpp"

#include <algorithm>
#include <cmath>

#include "libs/linalg/symmetric_eigen.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kForce_N = 0.05;

/// Points all along its flank.
robot::RobotBody RobotWithPlaces() {
  robot::RobotBody body = SmallRobot();
  const fem::PointLocator locator(body.mesh);
  body.feature_points.clear();
  for (const double x_m : {0.035, 0.055, 0.075, 0.095}) {
    body.feature_points.push_back(locator.Embed({x_m, 0.02, 0.01}));
  }
  return body;
}

class OtherPlaces : public HiddenFaults {
 protected:
  OtherPlaces() : HiddenFaults(RobotWithPlaces(), SmallExperiment(SmallRobot())) {}

  static constexpr int kAlong = 3;  ///< the parameter x_m of a force

  /// Forces [places] by how far out on the beam they are searched.
  std::vector<int> Forces() const {
    std::vector<int> forces;
    for (int k = 0; k < hypotheses_.size(); ++k) {
      if (hypotheses_.model(k).name().id == "permanent_force") forces.push_back(k);
    }
    std::sort(forces.begin(), forces.end(), [&](int a, int b) { return X_m(a) < X_m(b); });
    return forces;
  }
  double X_m(int force) const { return hypotheses_.model(force).parameters()[kAlong].nominal; }
  /// Where a fit has the force.
  double X_m(const Fit& fit, int force) const {
    return X_m(force) + fit.posterior.mean[hypotheses_.first(force) + kAlong];
  }

  /// A force sideways at one of the places it is searched at, `noise` times as noisy as usual.
  void MeasureForceAt(int force, double noise) {
    observed_.sigma_m *= noise;
    Measure({});
    Eigen::VectorXd z = Eigen::VectorXd::Zero(hypotheses_.parameter_count());
    z[hypotheses_.first(force) + 1] = kForce_N;
    const ModelHypothesis nominal = NominalHypothesis(body_, observed_);
    const Simulator simulator(observed_, 1);
    const Simulation without = simulator.Run(nominal);
    const Simulation with = simulator.Run(HypothesisWith(nominal, hypotheses_.All(), z));
    for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
      const Eigen::Matrix3Xd noise_m =
          observed_.samples[s].position_m - without.samples[s].markers_m();
      observed_.samples[s].position_m = with.samples[s].markers_m() + noise * noise_m;
    }
  }
  Fit FittedAt(const Fitter& fitter, int force) const {
    return fitter.Complete(fitter.Refine({force}, fitter.AsBuilt()));
  }
};

TEST_F(OtherPlaces, AFitMovesToWhereTheDataHaveTheForce) {
  const std::vector<int> forces = Forces();
  const int right = forces.back();
  const int wrong = forces.front();
  MeasureForceAt(right, 0.1);
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Fit stuck = FittedAt(fitter, wrong);
  ASSERT_TRUE(stuck.status.ok());
  int cause = wrong;
  const Fit moved = AtTheBestPlace(fitter, stuck, &cause);
  EXPECT_EQ(moved.faults, std::vector<int>{cause});
  EXPECT_GT(moved.posterior.ln_evidence, stuck.posterior.ln_evidence + 10.0) << "seed " << kSeed;
  EXPECT_LT(std::abs(X_m(moved, cause) - X_m(right)), 6e-3) << "seed " << kSeed;
}

TEST_F(OtherPlaces, OneThatIsWhereTheDataHaveItStays) {
  const int right = Forces().back();
  MeasureForceAt(right, 1.0);
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Fit fit = FittedAt(fitter, right);
  int cause = right;
  EXPECT_EQ(AtTheBestPlace(fitter, fit, &cause).z, fit.z);
  EXPECT_EQ(cause, right);
}

TEST_F(OtherPlaces, AreAllLeftOpenByDataThatDoNotTellThemApart) {
  const std::vector<int> forces = Forces();
  const int near = forces.back();
  MeasureForceAt(near, 30.0);
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const Fit fit = FittedAt(fitter, near);
  const Eigen::Index first = hypotheses_.first(near);
  const Eigen::MatrixXd own = fit.posterior.covariance.block<6, 6>(first, first);
  const Eigen::MatrixXd all = CovarianceOverPlaces(fitter, fit, near);
  EXPECT_LT(std::sqrt(own(kAlong, kAlong)),
            1.01 * hypotheses_.model(near).parameters()[kAlong].fault)
      << "its prior is near its place";
  EXPECT_GT(std::sqrt(all(kAlong, kAlong)), 0.02) << "seed " << kSeed;
  EXPECT_GT(linalg::SymmetricEigenvalues(all).minCoeff(), 0.0);
}

TEST_F(OtherPlaces, AreOfNoWeightWhereTheDataTell) {
  const int right = Forces().back();
  MeasureForceAt(right, 0.1);
  const Fitter fitter(observed_, body_, hypotheses_, {.relative_error = 1e-4}, 1);
  const Fit fit = FittedAt(fitter, right);
  const Eigen::Index first = hypotheses_.first(right);
  const Eigen::MatrixXd own = fit.posterior.covariance.block<6, 6>(first, first);
  EXPECT_TRUE(CovarianceOverPlaces(fitter, fit, right).isApprox(own, 0.05)) << "seed " << kSeed;
}

}  // namespace
}  // namespace palpate::diagnosis
