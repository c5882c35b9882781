// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "components/force_estimation/error_consistency.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/core/statistics.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kTip(0.0, 0.007, 0.03);
constexpr char kTipSite[] = "tip: 0, 0.007, 0.03, 0.005";

TEST(ForceUncertainty, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d force_N(0.05, -0.08, -0.15);
  const MarkerFrame clean = FrameUnder(*model, {}, {LoadAt(*model, kTip, 0.005, force_N)});
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite}));
  std::mt19937 random(20260101);
  constexpr int kDraws = 300;
  int size_covered = 0;
  int vector_covered = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    MarkerFrame frame = clean;
    AddNoise(1e-4, random, &frame);
    const ForceEstimate& estimate = estimator.Update(frame);
    ASSERT_TRUE(estimate.status.ok());
    const ContactForce& contact = estimate.contacts[0];
    size_covered += std::abs(contact.force_N.norm() - force_N.norm()) <= contact.ci95_N ? 1 : 0;
    const Eigen::Vector3d error_N = contact.force_N - force_N;
    constexpr double kChiSquared95 = 7.8147;
    // The Frobenius norm is at least the longest semi-axis of the ellipsoid, squared.
    EXPECT_LT(contact.ci95_N, std::sqrt(kChiSquared95 * contact.covariance_N2.norm()));
    vector_covered +=
        error_N.dot(contact.covariance_N2.inverse() * error_N) <= kChiSquared95 ? 1 : 0;
  }
  // The interval is symmetric, and holds for every direction that the force may have: conservative.
  EXPECT_GE(size_covered, 0.95 * kDraws);
  EXPECT_GE(vector_covered, 0.90 * kDraws);
  EXPECT_LE(vector_covered, 0.99 * kDraws);
}

/// Consistencies with the covariances as they are, half and twice as large.
struct Consistencies {
  void Add(const std::string& contact, const Eigen::Vector3d& error_N,
           const Eigen::Matrix3d& covariance_N2) {
    as_it_is.Add(contact, Normalise(error_N, covariance_N2));
    halved.Add(contact, Normalise(error_N, 0.5 * covariance_N2));
    doubled.Add(contact, Normalise(error_N, 2.0 * covariance_N2));
  }

  ErrorConsistency as_it_is, halved, doubled;
};

void ExpectTrue(const Consistencies& found) {
  EXPECT_GE(found.as_it_is.NeesPerDegree(), found.as_it_is.LowestExpected());
  EXPECT_LE(found.as_it_is.NeesPerDegree(), found.as_it_is.HighestExpected());
  EXPECT_GT(found.halved.NeesPerDegree(), found.halved.HighestExpected());
  EXPECT_LT(found.doubled.NeesPerDegree(), found.doubled.LowestExpected());
}

TEST(ForceUncertainty, SquaredErrorsAreWhatTheirCovariancesSay) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d force_N(0.05, -0.08, -0.15);
  const MarkerFrame clean = FrameUnder(*model, {}, {LoadAt(*model, kTip, 0.005, force_N)});
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite}));
  std::mt19937 random(20260102);
  Consistencies found;
  for (int draw = 0; draw < 100; ++draw) {
    MarkerFrame frame = clean;
    AddNoise(1e-4, random, &frame);
    const ForceEstimate& estimate = estimator.Update(frame);
    ASSERT_TRUE(estimate.status.ok());
    found.Add(std::to_string(draw), estimate.contacts[0].force_N - force_N,
              estimate.contacts[0].covariance_N2);
  }
  ExpectTrue(found);
  EXPECT_GE(found.as_it_is.ShareWithin95(), 0.9);
}

/// The force along the beam is not determined at the limit that is set, and left at zero. Its
/// variance, and what it adds to the others, are those of the friction that is drawn.
TEST(ForceUncertainty, OfAForceThatIsNotDeterminedIsThatOfFriction) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d middle_m(-0.06, 0.015, 0.03);
  constexpr double kPush_N = 0.5;
  Config config = WithContacts({"middle: -0.06, 0.015, 0.03, 0.005"});
  const MarkerFrame pushed =
      FrameUnder(*model, {}, {LoadAt(*model, middle_m, 0.005, {0.0, 0.0, -kPush_N})});
  const ContactForce whole = MarkerForceEstimator(*model, config).Update(pushed).contacts.at(0);
  config.unobservable_sigma_N = 0.9 * std::sqrt(whole.covariance_N2(0, 0));
  config.friction_sigma = 0.4;
  config.uncertain_share = 10.0;
  MarkerForceEstimator estimator(*model, config);
  std::mt19937 random(20260103);
  Consistencies found;
  for (int draw = 0; draw < 60; ++draw) {
    Eigen::Vector3d force_N = NormalNoise(config.friction_sigma * kPush_N, random);
    force_N.z() = -kPush_N;
    MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, middle_m, 0.005, force_N)});
    AddNoise(1e-4, random, &frame);
    const ForceEstimate& estimate = estimator.Update(frame);
    ASSERT_TRUE(estimate.status.ok());
    const ContactForce& contact = estimate.contacts[0];
    ASSERT_EQ(contact.status.code(), StatusCode::kTangentialUnobservable);
    const double friction_N = config.friction_sigma * contact.force_N.z();
    EXPECT_GT(contact.covariance_N2(0, 0), 0.5 * friction_N * friction_N);
    EXPECT_DOUBLE_EQ(contact.ci95_N, HalfWidthAlong95_N(contact.force_N, contact.covariance_N2));
    found.Add(std::to_string(draw), contact.force_N - force_N, contact.covariance_N2);
  }
  ExpectTrue(found);
}

TEST(ForceUncertainty, FalseContactsAreAsRareAsTheSignificanceSays) {
  const auto model = Build(BeamRobot());
  const MarkerFrame at_rest = FrameUnder(*model, {}, {});
  Config config = WithContacts({kTipSite});
  config.significance = 0.1;
  MarkerForceEstimator estimator(*model, config);
  std::mt19937 random(11);
  int contacts = 0;
  for (int draw = 0; draw < 200; ++draw) {
    MarkerFrame frame = at_rest;
    AddNoise(1e-4, random, &frame);
    contacts += estimator.Update(frame).status.ok() ? 1 : 0;
  }
  EXPECT_GE(contacts, 4);
  EXPECT_LE(contacts, 34);
}

TEST(ForceUncertainty, ResidualOfNoiseIsThatOfTheFreedomLeft) {
  const auto model = Build(BeamRobot());
  const MarkerFrame clean = FrameUnder(*model, {}, {LoadAt(*model, kTip, 0.005, {0, 0, -0.1})});
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite}));
  std::mt19937 random(5);
  constexpr int kDraws = 60;
  double chi_squared = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    MarkerFrame frame = clean;
    AddNoise(1e-4, random, &frame);
    const ForceEstimate& estimate = estimator.Update(frame);
    EXPECT_EQ(estimate.degrees_of_freedom, 36 - 3);
    EXPECT_NEAR(estimate.noise_rms_m, 1e-4, 1e-12);
    EXPECT_NEAR(estimate.residual_rms_m, estimate.marker_residual_m.norm() / 6.0, 1e-15);
    EXPECT_NEAR(estimate.chi_squared, estimate.marker_residual_m.squaredNorm() / 1e-8, 1e-6);
    chi_squared += estimate.chi_squared / kDraws;
  }
  EXPECT_NEAR(chi_squared, 33.0, 4.0 * std::sqrt(2.0 * 33.0 / kDraws));
}

TEST(ForceUncertainty, WidensWhereTheModelMissesTheMarkers) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, kTip, 0.005, {0, 0, -0.3})});
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite}));
  const double clean_N2 = estimator.Update(frame).contacts[0].covariance_N2.trace();
  std::mt19937 random(6);
  AddNoise(1e-3, random, &frame);
  const ForceEstimate& estimate = estimator.Update(frame);
  const double inflation = estimate.chi_squared / estimate.degrees_of_freedom;
  ASSERT_GT(inflation, 50.0);
  EXPECT_NEAR(estimate.contacts[0].covariance_N2.trace(), inflation * clean_N2,
              0.2 * inflation * clean_N2);
}

TEST(ForceUncertainty, TakesNoiseOfTheFrameElseOfTheSettings) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, kTip, 0.005, {0, 0, -0.3})});
  Config config = WithContacts({kTipSite});
  config.marker_sigma_m = 3e-4;
  config.marker_bias_m = 4e-4;
  MarkerForceEstimator estimator(*model, config);
  for (MarkerObservation& marker : frame.markers) marker.sigma_m.setZero();
  EXPECT_NEAR(estimator.Update(frame).noise_rms_m, 5e-4, 1e-12);
  const Eigen::Matrix3d covariance_N2 = estimator.Update(frame).contacts[0].covariance_N2;
  for (MarkerObservation& marker : frame.markers) marker.sigma_m.setConstant(3e-5);
  config.marker_bias_m = 0.0;
  MarkerForceEstimator sharper(*model, config);
  EXPECT_NEAR(sharper.Update(frame).noise_rms_m, 3e-5, 1e-12);
  const Eigen::Matrix3d scaled_N2 = std::pow(3e-5 / 5e-4, 2) * covariance_N2;
  EXPECT_TRUE(sharper.Update(frame).contacts[0].covariance_N2.isApprox(scaled_N2, 1e-2));
}

TEST(ForceUncertainty, ForceIsProportionalToTheModulusOfAWeightlessBody) {
  const auto model = Build(BeamRobot());
  model->SetGravity(Eigen::Vector3d::Zero());
  const Eigen::Vector3d force_N(0.1, -0.2, -0.5);
  const MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, kTip, 0.005, force_N)});
  model->SetYoungsModulus(0, 1.2 * model->body().materials[0].youngs_modulus_Pa);
  MarkerForceEstimator estimator(*model, WithContacts({kTipSite}));
  EXPECT_LT((estimator.Update(frame).contacts[0].force_N - 1.2 * force_N).norm(), 1e-6);
}

/// The force on the hub of four_leg with all moduli scaled; cables taut, slack and under tension.
Eigen::Vector3d ForceWithModulus(robot::RobotModel& model, const MarkerFrame& frame,
                                 double factor) {
  const double before_Pa = model.body().materials[0].youngs_modulus_Pa;
  const auto set_all = [&](double modulus_Pa) {
    for (size_t k = 0; k < model.body().materials.size(); ++k) {
      model.SetYoungsModulus(static_cast<int>(k), modulus_Pa);
    }
  };
  set_all(factor * before_Pa);
  MarkerForceEstimator estimator(model, WithContacts({"hub: 0, 0, 0.125, 0.008"}));
  const Eigen::Vector3d force_N = estimator.Update(frame).contacts[0].force_N;
  set_all(before_Pa);
  return force_N;
}

TEST(ForceUncertainty, ModulusErrorWidensTheIntervalByTheForcesDerivative) {
  const auto model = Build(QuickFourLegRobot());
  const std::vector<robot::ActuatorCommand> cables = {{Kind::kDisplacement, 0.006},
                                                      {Kind::kDisplacement, -0.02},
                                                      {Kind::kTension, 1.0},
                                                      {Kind::kDisplacement, 0.004}};
  const auto load = LoadAt(*model, {0.0, 0.0, 0.125}, 0.008, {0.2, -0.3, -0.8});
  const MarkerFrame frame = FrameUnder(*model, cables, {load});
  constexpr double kStep = 1e-4;
  const Eigen::Vector3d derivative_N = (ForceWithModulus(*model, frame, std::exp(kStep)) -
                                        ForceWithModulus(*model, frame, std::exp(-kStep))) /
                                       (2.0 * kStep);
  ASSERT_GT(derivative_N.norm(), 0.1);

  constexpr double kSigma = 0.3;
  MarkerForceEstimator exact(*model, WithContacts({"hub: 0, 0, 0.125, 0.008"}));
  MarkerForceEstimator unsure(*model, WithContacts({"hub: 0, 0, 0.125, 0.008"}), kSigma);
  const ContactForce& narrow = exact.Update(frame).contacts[0];
  const ContactForce& wide = unsure.Update(frame).contacts[0];
  const Eigen::Matrix3d expected = kSigma * kSigma * derivative_N * derivative_N.transpose();
  EXPECT_LT((wide.covariance_N2 - narrow.covariance_N2 - expected).norm(), 1e-4 * expected.norm());
  EXPECT_DOUBLE_EQ(wide.ci95_N, HalfWidth95_N(wide.force_N, wide.covariance_N2));
  EXPECT_GT(wide.ci95_N, 2.0 * narrow.ci95_N);
}

}  // namespace
}  // namespace palpate::force_estimation
