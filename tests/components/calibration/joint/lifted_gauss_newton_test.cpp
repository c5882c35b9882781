// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/lifted_gauss_newton.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <random>

#include "components/calibration/joint/gauss_newton.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"

namespace palpate::calibration {
namespace {

using testing::HasSubstr;

class ApproachToTheSolution : public testing::Test {
 protected:
  /// Pose and four tensions of the paper's Table I, with noise, from 0.5 N each.
  JointSetup TableOne() {
    std::mt19937_64 random(7);
    JointSetup setup;
    setup.frames = {See(*model_, TableOnePose(), "table_1",
                        Commands(Kind::kTension, {1.2, 1.0, 1.0, 1.2}), {}, 3e-4, &random)};
    for (int c = 0; c < model_->ActuatorCount(); ++c) {
      setup.frames[0].cables[static_cast<size_t>(c)] = {Kind::kTension, 0.5};
      setup.unknowns.push_back(CableInput(0, "table_1", c,
                                          model_->ActuatorNames()[static_cast<size_t>(c)],
                                          Kind::kTension, {.mean = 0.5, .lower = 0.0}));
    }
    setup.T_robot_camera = Disturbed(TableOnePose(), 0.2, 0.03);
    return setup;
  }

  /// Moduli and actuators of two loaded frames, whose inputs were recorded.
  JointSetup Moduli() {
    std::mt19937_64 random(8);
    const fem::InterpolationWeights hub = model_->body().markers.front().point.weights;
    JointSetup setup;
    for (const double pulled_m : {0.004, 0.007}) {
      setup.frames.push_back(See(*model_, TableOnePose(), "pulled",
                                 Commands(Kind::kDisplacement, {pulled_m, 0.006, 0.003, pulled_m}),
                                 {{hub, Eigen::Vector3d(0.3, 0.1, -0.2)}}, 3e-4, &random));
      for (robot::ActuatorCommand& cable : setup.frames.back().cables) cable.value -= 5e-4;
    }
    for (int c = 0; c < model_->ActuatorCount(); ++c) {
      setup.unknowns.push_back(CommandOffset(c, model_->ActuatorNames()[static_cast<size_t>(c)],
                                             {.sigma = 2e-3, .plausible = 2e-3}));
    }
    setup.unknowns.push_back(LogYoungsModulus(0, "body", 1.2e5, {.sigma = 0.5, .plausible = 0.5}));
    setup.T_robot_camera = Disturbed(TableOnePose(), 0.2, 0.03);
    return setup;
  }

  /// Shapes, residuals and derivatives are those of equilibria that are solved for its variables,
  /// and Ipopt ends where it does when it goes all the way itself.
  void ExpectSolution(const JointSetup& setup) {
    JointProblem problem(*model_, setup);
    const LiftedSolution lifted_gauss_newton = SolveLiftedGaussNewton(&problem, {});
    ASSERT_TRUE(lifted_gauss_newton.status.ok()) << lifted_gauss_newton.status.message();
    EXPECT_LE(lifted_gauss_newton.steps, 8);
    // The last step is short, and has the factor of the one before where that is the frame's own.
    EXPECT_EQ(lifted_gauss_newton.steps - lifted_gauss_newton.factorisations,
              setup.frames.size() == 1 ? 1 : 0);
    EXPECT_EQ(lifted_gauss_newton.objectives.size(),
              static_cast<size_t>(lifted_gauss_newton.steps) + 1);
    LeastSquaresPoint arrived, solved;
    ASSERT_TRUE(problem.Evaluate(lifted_gauss_newton.variables, &arrived).ok());
    JointProblem afresh(*model_, setup);
    ASSERT_TRUE(afresh.Evaluate(lifted_gauss_newton.variables, &solved).ok());
    for (std::size_t f = 0; f < setup.frames.size(); ++f) {
      const Eigen::VectorXd off_m = problem.states()[f].x_m - afresh.states()[f].x_m;
      EXPECT_LE(off_m.lpNorm<Eigen::Infinity>(), 1e-9);
      EXPECT_TRUE(
          problem.states()[f].multipliers_N.isApprox(afresh.states()[f].multipliers_N, 1e-6));
    }
    EXPECT_TRUE(arrived.residual.isApprox(solved.residual, 1e-6));
    EXPECT_TRUE(arrived.jacobian.isApprox(solved.jacobian, 1e-4));
    afresh.Accept();
    const LeastSquaresSolution all_the_way = SolveLeastSquares(afresh, {});
    ASSERT_TRUE(all_the_way.status.ok()) << all_the_way.status.message();
    EXPECT_TRUE(lifted_gauss_newton.variables.isApprox(all_the_way.variables, 1e-4));
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
};

TEST_F(ApproachToTheSolution, EndsInBalanceWithTensionsOfWhichNothingIsKnown) {
  ExpectSolution(TableOne());
}

TEST_F(ApproachToTheSolution, EndsInBalanceWithRecordedInputs) { ExpectSolution(Moduli()); }

TEST_F(ApproachToTheSolution, ThatLeadsNowhereLeavesTheShapesAsTheyWere) {
  JointSetup setup = Moduli();
  setup.frames[1].cables[0].value = 0.5;  // farther than the robot is long
  JointProblem problem(*model_, setup);
  const LiftedSolution lifted_gauss_newton = SolveLiftedGaussNewton(&problem, {});
  EXPECT_FALSE(lifted_gauss_newton.status.ok());
  EXPECT_EQ(lifted_gauss_newton.steps, 0);
  EXPECT_TRUE(lifted_gauss_newton.objectives.empty());
  for (const fem::StaticState& state : problem.states()) {
    EXPECT_EQ(state.x_m, model_->RestState().x_m);
  }
}

TEST_F(ApproachToTheSolution, MirroredMarkersAreRefused) {
  JointSetup setup = Moduli();
  for (CalibrationFrame& frame : setup.frames) {
    for (MarkerSighting& sighting : frame.markers) sighting.position_m.x() *= -1.0;
  }
  const JointCalibration fit = CalibrateFrames(*model_, setup.frames, nullptr, {});
  EXPECT_EQ(fit.status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(fit.status.message(), HasSubstr("mirrored"));
}

/// r = A (x + sin(x) / 4) - b with bounds that bite, and blocks that are outliers.
class Curved final : public LeastSquaresProblem {
 public:
  Curved() {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (double& entry : A_.reshaped()) entry = normal(random);
    for (double& entry : b_) entry = normal(random);
    b_[4] = 40.0;
  }

  Eigen::VectorXd Start() const override { return Eigen::VectorXd::Constant(4, 0.1); }
  Eigen::MatrixX2d Bounds() const override {
    Eigen::MatrixX2d bounds(4, 2);
    bounds.col(0).setConstant(-0.2);
    bounds.col(1).setConstant(0.3);
    bounds(3, 1) = std::numeric_limits<double>::infinity();
    return bounds;
  }
  Eigen::MatrixX2d ConstraintBounds() const override { return Eigen::MatrixX2d(0, 2); }
  std::vector<RobustBlock> RobustBlocks() const override { return {{0, 3}, {3, 3}}; }
  Status Evaluate(const Eigen::VectorXd& x, LeastSquaresPoint* point) override {
    point->residual = A_ * (x.array() + 0.25 * x.array().sin()).matrix() - b_;
    point->jacobian = A_ * (1.0 + 0.25 * x.array().cos()).matrix().asDiagonal();
    return Status::Ok();
  }

 private:
  Eigen::MatrixXd A_{9, 4};
  Eigen::VectorXd b_{9};
};

TEST(SolveWithinBounds, FindsWhatIpoptFinds) {
  Curved problem;
  const LeastSquaresSettings settings{.huber_threshold = 2.0};
  const LeastSquaresSolution expected = SolveLeastSquares(problem, settings);
  ASSERT_TRUE(expected.status.ok()) << expected.status.message();
  const LeastSquaresSolution found = SolveWithinBounds(problem, settings);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_LE((found.variables - expected.variables).lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_NEAR(found.objectives.back(), expected.objectives.back(), 1e-6);
  const Eigen::MatrixX2d bounds = problem.Bounds();
  EXPECT_GE(((found.variables - bounds.col(0)).array() == 0.0).count() +
                ((found.variables - bounds.col(1)).array() == 0.0).count(),
            1);
}

}  // namespace
}  // namespace palpate::calibration
