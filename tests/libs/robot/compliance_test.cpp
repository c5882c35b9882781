// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/compliance.hpp"

#include <gtest/gtest.h>

#include "libs/linalg/symmetric_eigen.hpp"
#include "tests/libs/robot/beam_model.hpp"

namespace palpate::robot {
namespace {

/// The beam pulled by both cables; three observed points, the first also where forces act along
/// x, y and z.
class ComplianceTest : public BeamModelTest {
 protected:
  void SetUp() override {
    model_ = Build(FullRobotText());
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.003, 0.085, 0.002), Eigen::Vector3d(-0.01, 0.05, 0.01),
          Eigen::Vector3d(0.0, 0.1, 0.016)}) {
      effectors_.push_back(fem::PointLocator(model_->body().mesh).Embed(point).weights);
    }
    compliance_ = std::make_unique<Compliance>(model_->linearisation(), RowsOfPoints(effectors_));
    std::vector<ForceDirection> forces;
    for (int i = 0; i < 3; ++i) forces.push_back({effectors_[0], Eigen::Vector3d::Unit(i)});
    compliance_->SetForces(forces);
    state_ = model_->RestState();
    Reach(lambda_a_, lambda_f_, &state_);
    ComputeAt(state_.x_m);
  }

  std::vector<DeadLoad> DeadLoads(const Eigen::VectorXd& lambda_f) const {
    return {{effectors_[0], Eigen::Vector3d(lambda_f)}};
  }

  /// The equilibrium under these tensions and forces.
  void Reach(const Eigen::VectorXd& lambda_a, const Eigen::VectorXd& lambda_f,
             fem::StaticState* state) {
    const fem::StaticResult result =
        model_->Solve({Pull(lambda_a[0]), Pull(lambda_a[1])}, DeadLoads(lambda_f), state);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
  }

  /// Linearises at any x under the present forces.
  void ComputeAt(const Eigen::VectorXd& x_m) {
    ASSERT_TRUE(model_->linearisation().Update(x_m, lambda_a_, state_.loads.external_force_N).ok());
    compliance_->Compute(x_m, model_->actuator_rest_m(), lambda_a_, lambda_f_);
  }

  Eigen::VectorXd Effectors(const Eigen::VectorXd& x_m) const {
    Eigen::VectorXd positions(9);
    for (size_t e = 0; e < 3; ++e) {
      positions.segment<3>(static_cast<Eigen::Index>(3 * e)) = effectors_[e].Position(x_m);
    }
    return positions;
  }

  Eigen::VectorXd Displacements(const Eigen::VectorXd& x_m) const {
    return Eigen::Vector2d(model_->cable(0).Displacement_m(x_m),
                           model_->cable(1).Displacement_m(x_m));
  }

  std::unique_ptr<RobotModel> model_;
  std::unique_ptr<Compliance> compliance_;
  std::vector<fem::InterpolationWeights> effectors_;
  fem::StaticState state_;
  Eigen::VectorXd lambda_a_ = Eigen::Vector2d(0.8, 0.4);
  Eigen::VectorXd lambda_f_ = Eigen::Vector3d(0.02, -0.01, 0.03);
};

TEST_F(ComplianceTest, MatricesAreTheDerivativesOfReSolvedEquilibria) {
  const double h = 1e-4;  // N
  for (Eigen::Index k = 0; k < 5; ++k) {
    Eigen::VectorXd a = Eigen::VectorXd::Zero(2);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(3);
    (k < 2 ? a[k] : f[k - 2]) = h;
    const Eigen::MatrixXd W_e = k < 2 ? compliance_->W_ea() : compliance_->W_ef();
    const Eigen::MatrixXd W_a = k < 2 ? compliance_->W_aa() : compliance_->W_af();
    const Eigen::Index column = k < 2 ? k : k - 2;
    fem::StaticState more = state_;
    fem::StaticState less = state_;
    Reach(lambda_a_ + a, lambda_f_ + f, &more);
    Reach(lambda_a_ - a, lambda_f_ - f, &less);
    const Eigen::VectorXd effectors = (Effectors(more.x_m) - Effectors(less.x_m)) / (2.0 * h);
    const Eigen::VectorXd cables = (Displacements(more.x_m) - Displacements(less.x_m)) / (2.0 * h);
    EXPECT_LE((W_e.col(column) - effectors).norm(), 1e-5 * effectors.norm()) << k;
    EXPECT_LE((W_a.col(column) - cables).norm(), 1e-5 * cables.norm()) << k;
  }
}

TEST_F(ComplianceTest, EquationsThreeAndFourHoldAtTheState) {
  Eigen::VectorXd effectors, displacements;
  compliance_->EffectorPositions(lambda_a_, lambda_f_, &effectors);
  compliance_->CableDisplacements(lambda_a_, lambda_f_, &displacements);
  EXPECT_LE((effectors - Effectors(state_.x_m)).norm(), 1e-9);
  EXPECT_LE((displacements - Displacements(state_.x_m)).norm(), 1e-9);
}

TEST_F(ComplianceTest, EquationsThreeFourAndSixPredictANearbyEquilibrium) {
  const Eigen::VectorXd a = lambda_a_ + Eigen::Vector2d(0.002, -0.001);
  const Eigen::VectorXd f = lambda_f_ + Eigen::Vector3d(1e-3, 5e-4, -1e-3);
  fem::StaticState there = state_;
  Reach(a, f, &there);
  Eigen::VectorXd effectors, displacements;
  compliance_->EffectorPositions(a, f, &effectors);
  compliance_->CableDisplacements(a, f, &displacements);
  Eigen::VectorXd x_m = state_.x_m;
  compliance_->UpdateConfiguration(a, f, 1.0, &x_m);
  const double moved = (there.x_m - state_.x_m).norm();
  EXPECT_GT(moved, 1e-4);
  EXPECT_LE((x_m - there.x_m).norm(), 0.02 * moved);
  EXPECT_LE((effectors - Effectors(there.x_m)).norm(), 0.02 * moved);
  EXPECT_LE((displacements - Displacements(there.x_m)).norm(), 0.02 * moved);
  // Eq. (6) moves the points as eq. (3) says.
  EXPECT_LE((Effectors(x_m) - effectors).norm(), 1e-12);
}

TEST_F(ComplianceTest, HalfAnUpdateGoesHalfTheWay) {
  const Eigen::VectorXd f = lambda_f_ + Eigen::Vector3d(1e-3, 0.0, 0.0);
  Eigen::VectorXd whole = state_.x_m;
  Eigen::VectorXd half = state_.x_m;
  compliance_->UpdateConfiguration(lambda_a_, f, 1.0, &whole);
  compliance_->UpdateConfiguration(lambda_a_, f, 0.5, &half);
  EXPECT_LE((whole - state_.x_m - 2.0 * (half - state_.x_m)).norm(), 1e-14);
}

TEST_F(ComplianceTest, ABodyOutOfBalanceIsBroughtIntoIt) {
  Eigen::VectorXd x_m = state_.x_m;
  compliance_->UpdateConfiguration(lambda_a_, lambda_f_ + Eigen::Vector3d(0.0, 0.0, 2e-3), 1.0,
                                   &x_m);
  const double away = (x_m - state_.x_m).norm();
  ComputeAt(x_m);
  compliance_->UpdateConfiguration(lambda_a_, lambda_f_, 1.0, &x_m);
  EXPECT_LE((x_m - state_.x_m).norm(), 0.05 * away);
}

TEST_F(ComplianceTest, CableComplianceIsSymmetricPositiveDefinite) {
  const Eigen::MatrixXd& W_aa = compliance_->W_aa();
  EXPECT_LE((W_aa - W_aa.transpose()).norm(), 1e-12 * W_aa.norm());
  EXPECT_GT(linalg::SymmetricEigenvalues(W_aa).minCoeff(), 0.0);
}

TEST_F(ComplianceTest, IsReciprocalBetweenForcesAndPoints) {
  // Forces act at the first point: what a cable does to it, it does to the cable (Maxwell-Betti).
  const Eigen::MatrixXd to_point = compliance_->W_ea().topRows(3);
  EXPECT_LE((to_point - compliance_->W_af().transpose()).norm(), 1e-12 * to_point.norm());
  const Eigen::MatrixXd own = compliance_->W_ef().topRows(3);
  EXPECT_LE((own - own.transpose()).norm(), 1e-12 * own.norm());
}

TEST_F(ComplianceTest, ReciprocityGivesTheResponseToOtherForces) {
  std::vector<ForceDirection> others;
  for (int i = 0; i < 3; ++i) others.push_back({effectors_[1], Eigen::Vector3d::Unit(i)});
  others.push_back({effectors_[2], Eigen::Vector3d(0.6, 0.0, -0.8)});
  compliance_->PrepareReciprocity();
  compliance_->SetForces(others);
  compliance_->ObserveByReciprocity();
  const Eigen::MatrixXd W_ef = compliance_->W_ef();
  const Eigen::MatrixXd W_af = compliance_->W_af();
  lambda_f_ = Eigen::VectorXd::Zero(4);
  ComputeAt(state_.x_m);
  EXPECT_GT(compliance_->W_af().norm(), 0.0);
  EXPECT_LE((W_ef - compliance_->W_ef()).norm(), 1e-11 * W_ef.norm());
  EXPECT_LE((W_af - compliance_->W_af()).norm(), 1e-11 * W_af.norm());
}

TEST_F(ComplianceTest, WithoutForceDirectionsOnlyTheCablesCount) {
  const Eigen::MatrixXd W_ea = compliance_->W_ea();
  compliance_->SetForces({});
  lambda_f_.resize(0);
  ComputeAt(state_.x_m);
  EXPECT_EQ(compliance_->W_ef().cols(), 0);
  EXPECT_LE((compliance_->W_ea() - W_ea).norm(), 1e-14 * W_ea.norm());
}

}  // namespace
}  // namespace palpate::robot
