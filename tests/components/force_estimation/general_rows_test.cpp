// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/shape/location_step.hpp"
#include "components/force_estimation/shape/surface_map.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kPushedTip(0.0, 0.015, 0.03);
constexpr double kRadius_m = 0.005;
const Eigen::Vector3d kGeneralForce_N(0.05, -0.1, -0.3);
constexpr double kSigma_m = 1e-4;

/// The beam, pushed at its tip, observed along the surface normals of its feature points.
class GeneralRows : public testing::Test {
 protected:
  GeneralRows() : model_(Build(BeamRobot())), fitter_(*model_, FitConfig()) {
    const robot::RobotBody& body = model_->body();
    for (size_t f = 0; f < body.feature_points.size(); ++f) {
      rows_.push_back(robot::RowOfPoint(body.feature_points[f].weights,
                                        body.feature_normals.col(static_cast<Eigen::Index>(f))));
    }
    fitter_.SetRows(rows_);
    free_ = SolveTruth(*model_, {}, {});
  }

  static Config FitConfig() {
    Config config;
    config.frame_tolerance = 1e-9;
    return config;
  }

  RowTargets TargetsAt(const Eigen::VectorXd& x_m) const {
    RowTargets targets;
    targets.rows = static_cast<int>(rows_.size());
    targets.value_m.resize(targets.rows);
    targets.weight = Eigen::VectorXd::Constant(targets.rows, 1.0 / (kSigma_m * kSigma_m));
    for (int r = 0; r < targets.rows; ++r) {
      targets.value_m[r] = rows_[static_cast<size_t>(r)].Value(x_m);
    }
    return targets;
  }

  ModelState StartState() const {
    return {.valid = true,
            .balanced = true,
            .x_m = free_.x_m,
            .lambda_a_N = free_.multipliers_N,
            .lambda_f_N = Eigen::VectorXd::Zero(3 * fitter_.SiteCount())};
  }

  FitSite SiteAt(const Eigen::Vector3d& position_m) const {
    return {.patch = model_->Patch(position_m, kRadius_m)};
  }

  std::unique_ptr<robot::RobotModel> model_;
  ForceNewton fitter_;
  std::vector<robot::ObservationRow> rows_;
  fem::StaticState free_;
};

TEST_F(GeneralRows, NormalDisplacementsTellAForceInThreeDirections) {
  const fem::StaticState truth =
      SolveTruth(*model_, {}, {LoadAt(*model_, kPushedTip, kRadius_m, kGeneralForce_N)});
  fitter_.SetSites({SiteAt(kPushedTip)});
  ModelState state = StartState();
  const ForceFit& fit = fitter_.Fit(TargetsAt(truth.x_m), {}, &state);
  ASSERT_TRUE(fit.status.ok());
  EXPECT_LT((state.lambda_f_N - kGeneralForce_N).norm(), 1e-6);
  EXPECT_LT(fit.residual_m.norm(), 1e-8);
}

TEST_F(GeneralRows, WithoutSitesTheFitIsTheEquilibrium) {
  fitter_.SetSites({});
  ModelState state = StartState();
  state.x_m = model_->RestState().x_m;  // away from it
  state.balanced = false;
  ASSERT_TRUE(fitter_.Fit(TargetsAt(free_.x_m), {}, &state).status.ok());
  EXPECT_LT((state.x_m - free_.x_m).norm(), 1e-8);
}

TEST_F(GeneralRows, AKeptFactorComesToTheSameFit) {
  fitter_.SetSites({SiteAt(kPushedTip)});
  fitter_.KeepFactor(true);
  ModelState state = StartState();
  int linearisations = 0;
  for (int k = 0; k <= 10; ++k) {
    const Eigen::Vector3d force_N = (1.0 + 0.002 * k) * kGeneralForce_N;
    const fem::StaticState truth =
        SolveTruth(*model_, {}, {LoadAt(*model_, kPushedTip, kRadius_m, force_N)});
    fitter_.ForgetFactor();
    if (k > 0) fitter_.KeepFactor(true);
    const ForceFit& fit = fitter_.Fit(TargetsAt(truth.x_m), {}, &state);
    ASSERT_TRUE(fit.status.ok()) << k;
    EXPECT_LT((state.lambda_f_N - force_N).norm(), 1e-6) << k;
    linearisations = fit.iterations;
  }
  // The same frame once more needs no step, a small change none with a new factor.
  const RowTargets last = TargetsAt(state.x_m);
  EXPECT_EQ(fitter_.Fit(last, {}, &state).iterations, 0);
  RowTargets moved = last;
  moved.value_m.array() += 1e-6;
  const ForceFit& fit = fitter_.Fit(moved, {}, &state);
  EXPECT_TRUE(fit.status.ok());
  EXPECT_EQ(fit.iterations, 0);
  EXPECT_GE(fit.chord_steps, 1);
  EXPECT_GE(linearisations, 1);
}

/// Two loadings, one after the other, with the factor of the first.
class KeptFactor : public GeneralRows {
 protected:
  KeptFactor() {
    fitter_.SetSites({SiteAt(kPushedTip)});
    fitter_.KeepFactor(true);
    state_ = StartState();
    EXPECT_TRUE(
        fitter_.Fit(TargetsUnder(kGeneralForce_N), {}, &state_, Work(kNoLimit)).status.ok());
  }

  RowTargets TargetsUnder(const Eigen::Vector3d& force_N) {
    return TargetsAt(
        SolveTruth(*model_, {}, {LoadAt(*model_, kPushedTip, kRadius_m, force_N)}).x_m);
  }
  fem::TimeBudget Work(double more) { return fitter_.BudgetOfWork(more); }

  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  ModelState state_;
};

TEST_F(KeptFactor, TakesFewStepsFarFromItsState) {
  const Eigen::Vector3d force_N = 1.02 * kGeneralForce_N;
  const ForceFit& fit = fitter_.Fit(TargetsUnder(force_N), {}, &state_, Work(kNoLimit));
  ASSERT_TRUE(fit.status.ok());
  EXPECT_EQ(fit.iterations, 0);
  EXPECT_LE(fit.chord_steps, 6);
  EXPECT_LT((state_.lambda_f_N - force_N).norm(), 1e-6);
}

TEST_F(KeptFactor, AFitStoppedByItsWorkSaysSoAndTheNextOnesArrive) {
  const Eigen::Vector3d force_N = 1.1 * kGeneralForce_N;
  const RowTargets targets = TargetsUnder(force_N);
  int stopped = 0;
  while (!fitter_.Fit(targets, {}, &state_, Work(2.0)).status.ok()) {
    ASSERT_EQ(fitter_.fit().status.code(), StatusCode::kBudgetReached);
    EXPECT_EQ(fitter_.fit().iterations, 0);
    EXPECT_GT(fitter_.fit().error, FitConfig().frame_tolerance);
    ASSERT_LT(++stopped, 10);
  }
  EXPECT_GE(stopped, 1);
  EXPECT_LT((state_.lambda_f_N - force_N).norm(), 1e-6);
}

TEST_F(GeneralRows, ShortForceStepsComeToTheSameFit) {
  const RowTargets targets = TargetsAt(
      SolveTruth(*model_, {}, {LoadAt(*model_, kPushedTip, kRadius_m, kGeneralForce_N)}).x_m);
  fitter_.SetSites({SiteAt(kPushedTip)});
  ModelState state = StartState();
  const int steps = fitter_.Fit(targets, {}, &state).iterations;
  fitter_.LimitForceStep(0.1 * kGeneralForce_N.norm());
  state = StartState();
  const ForceFit& fit = fitter_.Fit(targets, {}, &state);
  ASSERT_TRUE(fit.status.ok());
  EXPECT_GT(fit.iterations, steps + 3);
  EXPECT_LT((state.lambda_f_N - kGeneralForce_N).norm(), 1e-6);
}

TEST_F(GeneralRows, APriorHoldsTheForceBack) {
  const fem::StaticState truth =
      SolveTruth(*model_, {}, {LoadAt(*model_, kPushedTip, kRadius_m, kGeneralForce_N)});
  const RowTargets targets = TargetsAt(truth.x_m);
  fitter_.SetSites({SiteAt(kPushedTip)});
  ModelState state = StartState();
  const Eigen::Matrix3d free_covariance = fitter_.Fit(targets, {}, &state).covariance_N2;
  fitter_.SetForcePrior(1e10 * fem::QpMatrix::Identity(3, 3));
  const ForceFit& held = fitter_.Fit(targets, {}, &state);
  ASSERT_TRUE(held.status.ok());
  EXPECT_LT(state.lambda_f_N.norm(), 0.05 * kGeneralForce_N.norm());
  EXPECT_LT(held.covariance_N2.trace(), free_covariance.trace());
  EXPECT_LE(held.covariance_N2.diagonal().maxCoeff(), 1.001e-10);
}

TEST_F(GeneralRows, AMisplacedContactGoesWhereTheForceActs) {
  const SurfaceMap map(*model_);
  const MaterialPoint true_place = map.NearestAtRest(kPushedTip - Eigen::Vector3d(0.02, 0, 0));
  const fem::StaticState truth =
      SolveTruth(*model_, {}, {LoadAt(*model_, true_place.rest_m, kRadius_m, kGeneralForce_N)});
  const RowTargets targets = TargetsAt(truth.x_m);
  ShapeSite site;
  site.radius_m = kRadius_m;
  site.seen_sigma_m = 0.1;
  site.centre = map.NearestAtRest(true_place.rest_m + Eigen::Vector3d(0.004, 0.003, 0));
  site.seen_rest_m = site.centre.rest_m;
  LocationStep location(*model_, fitter_);
  ModelState state = StartState();
  const double start_m = (site.centre.rest_m - true_place.rest_m).norm();
  std::vector<LocatedForce> located;
  for (int k = 0; k < 8; ++k) {
    site.patch = model_->Patch(site.centre.rest_m, kRadius_m);
    fitter_.SetSites({{.patch = site.patch}});
    if (state.lambda_f_N.size() == 0) state.lambda_f_N = Eigen::Vector3d::Zero();
    ASSERT_TRUE(fitter_.Fit(targets, {}, &state).status.ok());
    ASSERT_TRUE(location.Compute({site}, targets, state, &located).ok());
    site.centre = map.NearestAtRest(site.centre.rest_m + located[0].step_rest_m);
  }
  EXPECT_GT(start_m, 0.004);
  EXPECT_LT((site.centre.rest_m - true_place.rest_m).norm(), 1e-3);
  EXPECT_LT((state.lambda_f_N - kGeneralForce_N).norm(), 0.05 * kGeneralForce_N.norm());
  // Not knowing the place costs certainty about the force, never gains any.
  const Eigen::Matrix3d known_place = fitter_.fit().covariance_N2;
  EXPECT_GE(located[0].force_covariance_N2.trace(), known_place.trace() * (1.0 - 1e-9));
  EXPECT_GT(located[0].location_covariance_m2.trace(), 0.0);
}

TEST_F(GeneralRows, TheSkinIsTheSameInEveryShape) {
  SurfaceMap map(*model_);
  const fem::StaticState bent =
      SolveTruth(*model_, {}, {LoadAt(*model_, kPushedTip, kRadius_m, kGeneralForce_N)});
  map.Deform(bent.x_m);
  const MaterialPoint at_rest = map.NearestAtRest(kPushedTip + Eigen::Vector3d(-0.03, 0.002, 0.0));
  const MaterialPoint found = map.NearestNow(map.PositionNow_m(at_rest));
  EXPECT_LT((found.rest_m - at_rest.rest_m).norm(), 1e-9);
  EXPECT_LT(found.distance_m, 1e-9);
  EXPECT_NEAR(map.NormalNow(at_rest).norm(), 1.0, 1e-12);
  EXPECT_GT(map.NormalNow(at_rest).dot(map.NormalAtRest(at_rest)), 0.5);
}

TEST_F(GeneralRows, TheSkinAroundAPointIsOnItsSideOfTheBody) {
  constexpr double kThroughTheBody_m = 0.05;
  const SurfaceMap map(*model_);
  const MaterialPoint place = map.NearestAtRest(kPushedTip - Eigen::Vector3d(0.02, 0, 0));
  const std::vector<int> around = map.TrianglesAround(place, kThroughTheBody_m);
  ASSERT_GT(around.size(), 1U);
  EXPECT_EQ(around.front(), place.triangle);
  for (const int triangle : around) {
    const MaterialPoint other{.triangle = triangle};
    EXPECT_GT(map.NormalAtRest(other).dot(map.NormalAtRest(place)), 0.0);
  }
  EXPECT_EQ(map.TrianglesAround(place, 0.0).front(), place.triangle);
  EXPECT_LT(map.TrianglesAround(place, 0.004).size(), around.size());
}

}  // namespace
}  // namespace palpate::force_estimation
