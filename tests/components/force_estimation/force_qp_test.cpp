// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/force_qp.hpp"

#include <gtest/gtest.h>

#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kRowSigma_m = 1e-4;

/// The undeformed beam, observed along the normals of its feature points; forces at two places.
class ForceQpOnBeam : public testing::Test {
 protected:
  ForceQpOnBeam()
      : model_(Build(BeamRobot())),
        compliance_(model_->linearisation(), Rows()),
        qp_(static_cast<int>(Rows().size()), model_->traits()) {
    const fem::StaticState rest = model_->RestState();
    const Eigen::VectorXd no_tension_N;
    EXPECT_TRUE(model_->linearisation()
                    .Update(rest.x_m, no_tension_N, Eigen::VectorXd::Zero(rest.x_m.size()))
                    .ok());
    std::vector<FitSite> sites;
    std::vector<robot::ForceDirection> directions;
    for (const Eigen::Vector3d& place_m :
         {Eigen::Vector3d(0.0, 0.015, 0.03), Eigen::Vector3d(-0.05, 0.03, 0.015)}) {
      sites.push_back({.patch = model_->Patch(place_m, 0.005)});
      for (int i = 0; i < 3; ++i) {
        directions.push_back({sites.back().patch.weights, Eigen::Vector3d::Unit(i)});
      }
    }
    qp_.SetSites(sites);
    compliance_.SetForces(directions);
    compliance_.Compute(rest.x_m, model_->actuator_rest_m(), no_tension_N, start_N_);
    qp_.Start({}, no_tension_N);
  }

  std::vector<robot::ObservationRow> Rows() const {
    const robot::RobotBody& body = model_->body();
    std::vector<robot::ObservationRow> rows;
    for (std::size_t f = 0; f < body.feature_points.size(); ++f) {
      rows.push_back(robot::RowOfPoint(body.feature_points[f].weights,
                                       body.feature_normals.col(static_cast<Eigen::Index>(f))));
    }
    return rows;
  }

  /// Rows that are off by `offsets_m` [rows] times kRowSigma_m, the last one not measured.
  RowTargets Targets(const Eigen::VectorXd& offsets) const {
    RowTargets targets;
    targets.rows = static_cast<int>(offsets.size()) - 1;
    targets.value_m = compliance_.delta_e_free_m() + kRowSigma_m * offsets;
    targets.weight = Eigen::VectorXd::Constant(offsets.size(), 1.0 / (kRowSigma_m * kRowSigma_m));
    targets.weight.tail<1>().setZero();
    return targets;
  }
  RowTargets SomeTargets() const {
    return Targets(Eigen::VectorXd::LinSpaced(compliance_.delta_e_free_m().size(), -1.0, 2.0));
  }
  void Solve(const RowTargets& targets) {
    ASSERT_TRUE(qp_.Solve(compliance_, targets, {}, start_N_).ok());
  }

  const Eigen::VectorXd start_N_ = Eigen::VectorXd::Zero(6);
  std::unique_ptr<robot::RobotModel> model_;
  robot::Compliance compliance_;
  ForceQp qp_;
};

TEST_F(ForceQpOnBeam, ForcesBalanceResidualAndPrior) {
  const fem::QpMatrix prior = 50.0 * fem::QpMatrix::Identity(6, 6);
  qp_.SetPrior(prior);
  const RowTargets targets = SomeTargets();
  Solve(targets);
  const Eigen::VectorXd residual_m =
      qp_.response().e0_m() + qp_.response().G() * qp_.lambda_f_N() - targets.value_m;
  const Eigen::VectorXd pull = qp_.Projection(targets, residual_m);
  EXPECT_LT((pull + prior * qp_.lambda_f_N()).norm(), 1e-9 * pull.norm());
  EXPECT_NEAR(qp_.ChiSquared(targets),
              residual_m.head(targets.rows).squaredNorm() / (kRowSigma_m * kRowSigma_m),
              1e-9 * qp_.ChiSquared(targets));
}

TEST_F(ForceQpOnBeam, DampingHoldsTheStartAndLeavesTheSolutionWhereItIs) {
  constexpr double kDamping = 0.1;
  const RowTargets targets = SomeTargets();
  Solve(targets);
  const Eigen::VectorXd solution_N = qp_.lambda_f_N();
  ASSERT_TRUE(qp_.Solve(compliance_, targets, {}, solution_N, kDamping).ok());
  EXPECT_LT((qp_.lambda_f_N() - solution_N).norm(), 1e-6 * solution_N.norm());
  ASSERT_TRUE(qp_.Solve(compliance_, targets, {}, start_N_, kDamping).ok());
  const Eigen::VectorXd damped_N = qp_.lambda_f_N();
  const Eigen::VectorXd residual_m =
      qp_.response().e0_m() + qp_.response().G() * damped_N - targets.value_m;
  const Eigen::VectorXd pull = qp_.Projection(targets, residual_m);
  const double hold = kDamping * qp_.Information(targets).diagonal().maxCoeff();
  EXPECT_LT((pull + hold * (damped_N - start_N_)).norm(), 1e-6 * pull.norm());
  EXPECT_LT(damped_N.norm(), solution_N.norm());
  ASSERT_TRUE(qp_.Solve(compliance_, targets, {}, solution_N, 1e12).ok());
  EXPECT_LT((qp_.lambda_f_N() - solution_N).norm(), 1e-6 * solution_N.norm());
}

TEST_F(ForceQpOnBeam, CovarianceIsTheInverseOfTheInformation) {
  const RowTargets targets = SomeTargets();
  Solve(targets);
  const Eigen::MatrixXd product = qp_.Covariance_N2(targets) * qp_.Information(targets);
  EXPECT_LT((product - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-6);
  EXPECT_EQ(qp_.UnfittedError(targets, qp_.Covariance_N2(targets)).cols(), 0);
}

TEST_F(ForceQpOnBeam, AForceAlongAnUnfittedTangentErrsAsStated) {
  RowTargets targets = SomeTargets();
  Solve(targets);
  // Between the sigmas of the best and the worst known component some tangent is left out.
  const Eigen::VectorXd sigma_N =
      Eigen::VectorXd(qp_.Covariance_N2(targets).diagonal()).cwiseSqrt();
  qp_.KeepObservable(targets, 0.9 * sigma_N.maxCoeff());
  const fem::QpMatrix tangents = qp_.observable().unfitted();
  ASSERT_GT(tangents.cols(), 0);
  Solve(targets);
  const fem::QpMatrix error = qp_.UnfittedError(targets, qp_.Covariance_N2(targets));
  const Eigen::VectorXd without_N = qp_.lambda_f_N();
  targets.value_m += qp_.response().G() * tangents.col(0);
  Solve(targets);
  const Eigen::VectorXd moved_N = qp_.lambda_f_N() - without_N;
  EXPECT_LT((moved_N - tangents.col(0) - error.col(0)).norm(), 1e-6);
}

TEST_F(ForceQpOnBeam, OtherSitesHaveNoPrior) {
  qp_.SetPrior(fem::QpMatrix::Identity(6, 6));
  const std::vector<FitSite> one = {qp_.sites().front()};
  qp_.SetSites(one);
  EXPECT_EQ(qp_.prior(), fem::QpMatrix::Zero(3, 3));
  EXPECT_EQ(qp_.lambda_f_N(), Eigen::VectorXd::Zero(3));
}

}  // namespace
}  // namespace palpate::force_estimation
