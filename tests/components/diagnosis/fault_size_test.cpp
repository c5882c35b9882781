// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/forward_selection.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

/// Why a gain of this size, tolerance 0.005, of which at most 0.2 is plausible, is no fault.
std::string WhyNot(double gain) {
  std::vector<FaultModelPtr> causes;
  causes.push_back(std::make_unique<ToyFault>(
      "gain", std::vector<FaultParameter>{
                  {.name = "g", .tolerance = 0.005, .fault = 0.08, .plausible = 0.2}}));
  const HypothesisSet hypotheses(std::move(causes), {});
  Posterior posterior;
  posterior.mean = Eigen::VectorXd::Constant(1, gain);
  posterior.covariance = Eigen::MatrixXd::Constant(1, 1, 1e-6);
  return WhyNoFault(hypotheses, posterior, 0);
}

TEST(FaultSize, IsBeyondThreeTolerancesOnEitherSide) {
  EXPECT_THAT(WhyNot(0.014), testing::HasSubstr("manufacturing tolerances"));
  EXPECT_THAT(WhyNot(-0.014), testing::HasSubstr("manufacturing tolerances"));
  EXPECT_EQ(WhyNot(0.016), "");
  EXPECT_EQ(WhyNot(-0.016), "");
}

TEST(FaultSize, IsNotMoreThanARobotCanHave) {
  EXPECT_EQ(WhyNot(0.19), "");
  EXPECT_THAT(WhyNot(0.21), testing::HasSubstr("g = 0.21"));
  EXPECT_THAT(WhyNot(-0.24), testing::HasSubstr("another fault"));
}

/// A place that is off by so much, 1 mm being the tolerance of its length.
std::string WhyNotOff(const Eigen::Vector3d& off_m) {
  const FaultParameter along{
      .name = "d_m", .tolerance = 1e-3 / std::sqrt(3.0), .fault = 5e-3, .component = true};
  std::vector<FaultModelPtr> causes;
  causes.push_back(
      std::make_unique<ToyFault>("place", std::vector<FaultParameter>{along, along, along}));
  const HypothesisSet hypotheses(std::move(causes), {});
  Posterior posterior;
  posterior.mean = off_m;
  posterior.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  return WhyNoFault(hypotheses, posterior, 0);
}

TEST(FaultSize, OfAVectorIsItsLengthWhereverItPoints) {
  for (const Eigen::Vector3d& towards :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(1, -1, 1),
        Eigen::Vector3d(0.2, 0.5, -0.7)}) {
    EXPECT_THAT(WhyNotOff(2.9e-3 * towards.normalized()),
                testing::HasSubstr("manufacturing tolerances"));
    EXPECT_EQ(WhyNotOff(3.1e-3 * towards.normalized()), "");
  }
}

/// Of what a nominal robot has nothing of: two sizes known to these sigmas, correlated, and where
/// it acts.
std::string WhyNotBoth(double a, double b, double correlation) {
  std::vector<FaultModelPtr> causes;
  causes.push_back(std::make_unique<ToyFault>(
      "both", std::vector<FaultParameter>{{.name = "a", .fault = 1.0},
                                          {.name = "b", .fault = 1.0},
                                          {.name = "x", .fault = 1.0, .qualifies = true}}));
  const HypothesisSet hypotheses(std::move(causes), {});
  Posterior posterior;
  posterior.mean = Eigen::Vector3d(a, b, 0.0);
  posterior.covariance = Eigen::Matrix3d::Identity();
  posterior.covariance(0, 1) = posterior.covariance(1, 0) = correlation;
  return WhyNoFault(hypotheses, posterior, 0);
}

TEST(FaultSize, DoesNotExcludeNothingWhereItIsKnownNoBetter) {
  EXPECT_THAT(WhyNotBoth(1.5, 0.5, 0.0), testing::HasSubstr("two standard deviations"));
  EXPECT_EQ(WhyNotBoth(5.0, 0.0, 0.0), "");
  EXPECT_EQ(WhyNotBoth(0.0, -5.0, 0.0), "");
  EXPECT_EQ(WhyNotBoth(1.5, 1.5, -0.9), "");  // each may be nothing, their sum may not
}

/// A size that is 1.5 of its sigmas, and a time constant; data may tell the rate alone.
std::string WhyNotSlow(double correlation) {
  std::vector<FaultModelPtr> causes;
  causes.push_back(std::make_unique<ToyFault>(
      "slow", std::vector<FaultParameter>{{.name = "g", .fault = 1.0},
                                          {.name = "tau_s", .fault = 1.0, .qualifies = true}}));
  const HypothesisSet hypotheses(std::move(causes), {});
  Posterior posterior;
  posterior.mean = Eigen::Vector2d(1.5, 4.0);
  posterior.covariance = Eigen::Matrix2d{{1.0, correlation}, {correlation, 1.0}};
  return WhyNoFault(hypotheses, posterior, 0);
}

TEST(FaultSize, ExcludesNothingWhereWhatQualifiesItIsUnknown) {
  EXPECT_THAT(WhyNotSlow(0.0), testing::HasSubstr("two standard deviations"));
  EXPECT_THAT(WhyNotSlow(0.5), testing::HasSubstr("two standard deviations"));
  EXPECT_EQ(WhyNotSlow(0.9), "");  // sqrt(1 - 0.9^2) = 0.44 at that time constant
}

/// A delay, tolerance 0.01 s, and a time constant that a nominal robot has nothing of, known to
/// these sigmas.
std::string WhyNotLate(const Eigen::Vector2d& late_s, const Eigen::Vector2d& sigma_s,
                       double correlation) {
  std::vector<FaultModelPtr> causes;
  causes.push_back(std::make_unique<ToyFault>(
      "late", std::vector<FaultParameter>{
                  {.name = "delay_s", .tolerance = 0.01, .fault = 0.15, .least = 0.0},
                  {.name = "tau_s", .fault = 0.15, .least = 0.0}}));
  const HypothesisSet hypotheses(std::move(causes), {});
  Posterior posterior;
  posterior.mean = late_s;
  posterior.covariance = sigma_s.cwiseAbs2().asDiagonal();
  posterior.covariance(0, 1) = posterior.covariance(1, 0) = correlation * sigma_s[0] * sigma_s[1];
  return WhyNoFault(hypotheses, posterior, 0);
}

TEST(FaultSize, OfWhatIsKnownTogetherCountsTogether) {
  EXPECT_EQ(WhyNotLate({0.02, 0.08}, {0.035, 0.035}, -0.99), "");  // 0.1 s in all, +- 0.005
  EXPECT_THAT(WhyNotLate({0.02, 0.008}, {0.035, 0.035}, -0.99),
              testing::HasSubstr("manufacturing tolerances"));
  EXPECT_THAT(WhyNotLate({0.02, 0.08}, {0.035, 0.035}, 0.0),
              testing::HasSubstr("manufacturing tolerances"));
  EXPECT_EQ(WhyNotLate({0.02, 0.12}, {0.035, 0.035}, 0.0), "");
  EXPECT_EQ(WhyNotLate({0.05, 0.0}, {0.005, 0.0}, 0.0), "");  // at its bound
  EXPECT_EQ(WhyNotLate({0.0, 0.05}, {0.0, 0.01}, 0.0), "");
  EXPECT_THAT(WhyNotLate({0.0, 0.02}, {0.0, 0.01}, 0.0),
              testing::HasSubstr("manufacturing tolerances"));
}

}  // namespace
}  // namespace palpate::diagnosis
