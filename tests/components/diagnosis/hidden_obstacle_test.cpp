// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/forward/sample_solver.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/inference/fitter.hpp"
#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

/// The beam is bent sideways and up; an obstacle stands beside it at its tip.
class HiddenObstacle : public testing::Test {
 protected:
  Simulation Run(const std::optional<Obstacle>& obstacle, const Simulation* start = nullptr) const {
    ModelHypothesis hypothesis = nominal_;
    hypothesis.obstacle = obstacle;
    return simulator_.Run(hypothesis, start);
  }

  /// An obstacle that ends `share` of how far the body goes along `way`.
  Obstacle ObstacleAcross(const Eigen::Vector3d& way, double share) const {
    const Eigen::Vector3d normal = -way.normalized();
    const double undeformed_m = NearestAlong(*surface_, normal, nominal_.assembled_m);
    double reached_m = undeformed_m;
    for (const SimulatedSample& sample : as_built_.samples) {
      reached_m = std::min(reached_m, NearestAlong(*surface_, normal, sample.middle.state.x_m));
    }
    return {surface_, normal, undeformed_m + share * (reached_m - undeformed_m)};
  }

  robot::RobotBody body_ = SmallRobot();
  experiment::Experiment experiment_ = SmallExperiment(body_);
  ObservedExperiment observed_ = Observe(experiment_, body_, {.most_samples = 14});
  ModelHypothesis nominal_ = NominalHypothesis(body_, observed_);
  Simulator simulator_{observed_, 1};
  Simulation as_built_ = simulator_.Run(nominal_);
  std::shared_ptr<const ObstacleSurface> surface_ =
      std::make_shared<const ObstacleSurface>(SurfaceForObstacles(body_));
};

TEST_F(HiddenObstacle, PressesOnlyWhereItIsTouched) {
  constexpr double kDeepest_m = 1e-5;
  constexpr double kExact_m = 2e-9;
  const Obstacle obstacle = ObstacleAcross({0.1, -0.3, 1.0}, 0.4);
  const Simulation run = Run(obstacle, &as_built_);
  ASSERT_TRUE(run.status.ok()) << run.status.message();
  int touching = 0;
  for (std::size_t s = 0; s < run.samples.size(); ++s) {
    const Eigen::VectorXd& x_m = run.samples[s].middle.state.x_m;
    EXPECT_GT(ObstacleClearance_m(obstacle, x_m), -kDeepest_m) << "sample " << s;
    const Eigen::VectorXd& force_N = run.samples[s].middle.obstacle_force_N;
    touching += run.samples[s].middle.AtObstacle();
    EXPECT_TRUE(run.samples[s].middle.AtObstacle() ||
                ObstacleClearance_m(obstacle, x_m) > -kExact_m);
    for (Eigen::Index k = 0; k < force_N.size(); ++k) {
      const double depth_m = obstacle.Depth_m(surface_->nodes[static_cast<std::size_t>(k)], x_m);
      EXPECT_GE(force_N[k], 0.0);
      EXPECT_NEAR(std::max(0.0, depth_m), force_N[k] / surface_->stiffness_N_m, kExact_m);
    }
  }
  EXPECT_GT(touching, 2);
  EXPECT_LT(touching, std::ssize(run.samples)) << "it is met in some of the moments only";
}

TEST_F(HiddenObstacle, IsInBalanceWithTheBody) {
  const Obstacle obstacle = ObstacleAcross({0.1, -0.3, 1.0}, 0.4);
  ModelHypothesis hypothesis = nominal_;
  hypothesis.obstacle = obstacle;
  SampleSolver solver(hypothesis, observed_);
  const ActuatorChain train(observed_);
  const Eigen::MatrixXd taken_in = train.At(hypothesis.actuators);
  const auto most = std::max_element(as_built_.samples.begin(), as_built_.samples.end(),
                                     [&](const auto& a, const auto& b) {
                                       return ObstacleClearance_m(obstacle, a.middle.state.x_m) >
                                              ObstacleClearance_m(obstacle, b.middle.state.x_m);
                                     });
  const auto s = most - as_built_.samples.begin();
  SimulatedSample solved;
  solver.Solve(observed_.samples[static_cast<std::size_t>(s)], taken_in.col(s), {}, &solved);
  ASSERT_TRUE(solved.status.ok()) << solved.status.message();
  ASSERT_TRUE(solved.middle.AtObstacle());
  // Weight, loads, cables, obstacle and base: what the base gives is minus all else.
  const Eigen::VectorXd& x_m = solved.middle.state.x_m;
  const Eigen::VectorXd obstacle_N =
      NodalForces_N(obstacle, solved.middle.obstacle_force_N, x_m.size());
  Eigen::VectorXd nodal_N = solved.middle.state.loads.external_force_N + obstacle_N;
  robot::RobotModel& model = solver.model();
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    model.cable(c).AddGradient(x_m, -solved.middle.state.multipliers_N[c], nodal_N);
  }
  Eigen::VectorXd elastic_N = Eigen::VectorXd::Zero(x_m.size());
  model.elastic_body().AddForces(x_m, elastic_N);
  const auto moment_Nm = [&](const Eigen::VectorXd& force_N) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int node = 0; node < body_.mesh.NodeCount(); ++node) {
      sum += x_m.segment<3>(3 * node).cross(force_N.segment<3>(3 * node));
    }
    return sum;
  };
  EXPECT_LT(moment_Nm(elastic_N).norm(), 1e-9) << "elastic forces have no moment";
  const Eigen::VectorXd left_N = nodal_N - elastic_N;
  for (int node = 0; node < body_.mesh.NodeCount(); ++node) {
    if (body_.fixed.col(node).all()) continue;
    EXPECT_LT(left_N.segment<3>(3 * node).norm(), 1e-7) << "node " << node;
  }
  EXPECT_GT(obstacle_N.reshaped(3, x_m.size() / 3).rowwise().sum().norm(), 1e-3);
}

TEST_F(HiddenObstacle, FarAwayChangesNothing) {
  constexpr double kSettled_m = 2e-9;
  const Simulation with = Run(Obstacle{surface_, Eigen::Vector3d::UnitZ(), -1.0});
  for (std::size_t s = 0; s < with.samples.size(); ++s) {
    const auto differ_m = [&](const auto& a, const auto& b) {
      return (a - b).cwiseAbs().maxCoeff();
    };
    EXPECT_FALSE(with.samples[s].middle.AtObstacle());
    EXPECT_LT(differ_m(with.samples[s].middle.state.x_m, as_built_.samples[s].middle.state.x_m),
              kSettled_m);
    EXPECT_LT(differ_m(with.samples[s].markers_m(), as_built_.samples[s].markers_m()), kSettled_m);
  }
}

TEST_F(HiddenObstacle, IsMetWhereverASimulationStarts) {
  const Obstacle obstacle = ObstacleAcross({0.1, -0.3, 1.0}, 0.3);
  const Obstacle before = ObstacleAcross({0.2, -0.2, 1.0}, 0.5);
  const Simulation cold = Run(obstacle);
  const Simulation from_free = Run(obstacle, &as_built_);
  const Simulation beside = Run(before, &as_built_);
  const Simulation from_beside = Run(obstacle, &beside);
  ASSERT_TRUE(cold.status.ok() && from_free.status.ok() && from_beside.status.ok());
  const Simulation free_again = Run(std::nullopt, &from_beside);
  constexpr double kSame_m = 1e-6;  // how a sample bends is kept where the obstacle is far
  for (std::size_t s = 0; s < cold.samples.size(); ++s) {
    const auto differ_m = [&](const Simulation& a, const Simulation& b) {
      return (a.samples[s].markers_m() - b.samples[s].markers_m()).cwiseAbs().maxCoeff();
    };
    EXPECT_LT(differ_m(cold, from_free), kSame_m) << "sample " << s;
    EXPECT_LT(differ_m(cold, from_beside), kSame_m) << "sample " << s;
    EXPECT_LT(differ_m(free_again, as_built_), kSame_m) << "sample " << s;
  }
}

/// All that can be said of an obstacle, from what is seen of one.
class HiddenObstacleIsFound : public HiddenObstacle {
 protected:
  /// The markers where `truth` has them, with noise of 0.1 mm.
  void Measure(const Simulation& truth) {
    constexpr double kNoise_m = 1e-4;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (std::size_t s = 0; s < truth.samples.size(); ++s) {
      Sample& sample = observed_.samples[s];
      for (Eigen::Index m = 0; m < sample.count.size(); ++m) {
        const double sigma_m = kNoise_m / std::sqrt(std::max(1, sample.count[m]));
        for (int axis = 0; axis < 3; ++axis) {
          sample.position_m(axis, m) =
              truth.samples[s].markers_m()(axis, m) + sigma_m * normal(random);
        }
      }
    }
    observed_.sigma_m.setConstant(kNoise_m);
  }

  HypothesisSet Book() const {
    return {MakeFaultModels({.body = body_, .observed = observed_, .as_built = &as_built_}, {}),
            {}};
  }

  /// Data and model are of one mesh.
  Selection Select(const HypothesisSet& hypotheses) const {
    const Fitter fitter(observed_, body_, hypotheses, {.relative_error = 1e-4}, 1);
    return SelectFaults(observed_, fitter, fitter.AsBuilt(&as_built_), 1,
                        [](int, int, const std::string&) {});
  }
};

TEST_F(HiddenObstacleIsFound, ByWhatAWholeWallDoesToFirstOrder) {
  // Where it is met somewhere else once the body leans on it the first order is far off.
  constexpr double kTypically = 0.4;
  const HypothesisSet hypotheses = Book();
  std::vector<double> off_before;
  std::vector<double> off_after;
  for (int k = 0; k < hypotheses.size(); ++k) {
    const FaultModel& cause = hypotheses.model(k);
    if (cause.name().id != "hidden_obstacle") continue;
    const FaultModelList one{&cause};
    Simulation null_model = as_built_;
    simulator_.Differentiate(nominal_, one, Eigen::Vector4d::Zero(), {true}, nominal_, &null_model);
    const Eigen::Vector4d there = Eigen::Vector4d::UnitX();
    const ModelHypothesis hypothesis = HypothesisWith(nominal_, one, there);
    Simulation met = simulator_.Run(hypothesis, &as_built_);
    ASSERT_TRUE(met.status.ok()) << met.status.message();
    simulator_.Differentiate(hypothesis, one, there, {true}, nominal_, &met);
    double effect = 0.0, before = 0.0, after = 0.0;
    for (std::size_t s = 0; s < met.samples.size(); ++s) {
      const Eigen::VectorXd moved_m =
          (met.samples[s].markers_m() - as_built_.samples[s].markers_m()).reshaped();
      effect += moved_m.squaredNorm();
      before += (moved_m - null_model.samples[s].jacobian_m.col(0)).squaredNorm();
      after += (moved_m - met.samples[s].jacobian_m.col(0)).squaredNorm();
    }
    off_before.push_back(std::sqrt(before / effect));
    off_after.push_back(std::sqrt(after / effect));
  }
  ASSERT_GT(off_before.size(), 20U);
  const auto median = [](std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
    return values[values.size() / 2];
  };
  EXPECT_LT(median(off_before), kTypically) << "where it is not there";
  EXPECT_LT(median(off_after), kTypically) << "where it is there";
}

TEST_F(HiddenObstacleIsFound, WithItsGapAndItsNormal) {
  constexpr double kSigmas = 3.0;
  constexpr double k95 = 1.959964;
  constexpr double kMostTurn_rad = 0.35;  // a corner that touches tells little of turns about it
  const Obstacle obstacle = ObstacleAcross({0.15, -0.4, 1.0}, 0.6);
  Measure(Run(obstacle, &as_built_));
  const HypothesisSet hypotheses = Book();
  const Selection selection = Select(hypotheses);
  ASSERT_EQ(selection.named.size(), 1U);
  const int k = selection.named[0].fault;
  ASSERT_EQ(hypotheses.model(k).name().id, "hidden_obstacle");
  EXPECT_TRUE(selection.goodness_of_fit.passed) << selection.goodness_of_fit.worst;
  const Posterior& posterior = selection.best.posterior;
  const Eigen::Index first = hypotheses.first(k);
  const std::vector<FittedParameter> report = hypotheses.model(k).Report(
      posterior.mean.segment<4>(first), posterior.covariance.block<4, 4>(first, first),
      nominal_.assembled_m);
  const auto expect_near = [&](const FittedParameter& fitted, const std::string& name,
                               double truth) {
    EXPECT_EQ(fitted.name, name);
    const double sigma = (fitted.ci95_high - fitted.value) / k95;
    EXPECT_NEAR(fitted.value, truth, kSigmas * sigma) << name;
  };
  expect_near(report[0], "gap_m", ObstacleClearance_m(obstacle, nominal_.assembled_m));
  expect_near(report[1], "nx", obstacle.normal.x());
  expect_near(report[2], "ny", obstacle.normal.y());
  expect_near(report[3], "nz", obstacle.normal.z());
  const Eigen::Vector3d found{report[1].value, report[2].value, report[3].value};
  EXPECT_GT(found.dot(obstacle.normal), std::cos(kMostTurn_rad));
}

TEST_F(HiddenObstacleIsFound, AndOneThatAFitHasInTheSkinTouchesIt) {
  const HypothesisSet hypotheses = Book();
  int k = 0;
  while (hypotheses.model(k).name().id != "hidden_obstacle") ++k;
  const FaultModel& obstacle = hypotheses.model(k);
  for (const double deep_m : {5e-5, 5e-3}) {  // the deeper in a body that is larger than its file's
    const Eigen::Vector4d z(1.0, obstacle.parameters()[1].least - deep_m, 0.0, 0.0);
    const auto report =
        obstacle.Report(z, 1e-12 * Eigen::Matrix4d::Identity(), nominal_.assembled_m);
    EXPECT_EQ(report[0].value, 0.0);
    EXPECT_EQ(report[0].ci95_low, 0.0);
    for (const FittedParameter& one : report) {
      EXPECT_LE(one.ci95_low, one.value) << one.name << ", " << deep_m << " m deep";
      EXPECT_GE(one.ci95_high, one.value) << one.name << ", " << deep_m << " m deep";
    }
  }
}

TEST_F(HiddenObstacleIsFound, AsFarAsItIsFromABodyOfAnotherSize) {
  const HypothesisSet hypotheses = Book();
  int k = 0;
  while (hypotheses.model(k).name().id != "hidden_obstacle") ++k;
  const FaultModel& obstacle = hypotheses.model(k);
  const Eigen::Vector4d z(1.0, 0.0, 0.0, 0.0);
  const Eigen::Matrix4d sure = 1e-12 * Eigen::Matrix4d::Identity();
  const auto gap_m = [&](const Eigen::VectorXd& undeformed_m) {
    return obstacle.Report(z, sure, undeformed_m)[0].value;
  };
  const auto normal = obstacle.Report(z, sure, nominal_.assembled_m);
  const Eigen::Vector3d n{normal[1].value, normal[2].value, normal[3].value};
  constexpr double kNearer_m = 2e-4;
  const Eigen::VectorXd nearer_m =
      nominal_.assembled_m - kNearer_m * n.replicate(nominal_.assembled_m.size() / 3, 1);
  EXPECT_NEAR(gap_m(nearer_m), gap_m(nominal_.assembled_m) - kNearer_m, 1e-9);
}

/// An obstacle through the body, however far it is moved.
class ObstacleThroughTheBody final : public FaultModel {
 public:
  explicit ObstacleThroughTheBody(std::shared_ptr<const ObstacleSurface> surface)
      : FaultModel({"hidden_obstacle", {"body"}}, "a wall through the body",
                   {{.name = "gap_m", .fault = 1.0, .fault_at = 1.0}}),
        surface_(std::move(surface)) {}

  void Apply(const Eigen::VectorXd& /*z*/, ModelHypothesis* hypothesis) const override {
    hypothesis->obstacle = Obstacle{surface_, Eigen::Vector3d::UnitZ(), 1.0};
  }
  /// As if it explained what is measured.
  void OnView(int /*parameter*/, const Eigen::VectorXd& /*z*/, const FaultContext& at,
              Eigen::Matrix3Xd* seen_m) const override {
    *seen_m = at.seen().position_m - at.simulated().markers_m();
  }

 private:
  std::shared_ptr<const ObstacleSurface> surface_;
};

TEST_F(HiddenObstacleIsFound, NowhereThatTheBodyCannotBe) {
  const Obstacle obstacle = ObstacleAcross({0.15, -0.4, 1.0}, 0.6);
  Measure(Run(obstacle, &as_built_));
  std::vector<FaultModelPtr> causes;
  causes.push_back(std::make_unique<ObstacleThroughTheBody>(surface_));
  const HypothesisSet hypotheses(std::move(causes), {});
  const Fitter fitter(observed_, body_, hypotheses, {.relative_error = 1e-4}, 1);
  const Fit as_built = fitter.AsBuilt(&as_built_);
  ASSERT_GT(fitter.LinearPosterior(as_built, {0}).ln_evidence,
            as_built.posterior.ln_evidence + 10.0);
  const Fit fit = fitter.Complete(fitter.Refine({0}, as_built));
  EXPECT_FALSE(fit.status.ok());
  const Simulation none = Run(Obstacle{surface_, Eigen::Vector3d::UnitZ(), 1.0}, &as_built_);
  EXPECT_FALSE(none.status.ok());
  for (const SimulatedSample& sample : none.samples) {
    EXPECT_TRUE(!sample.status.ok() && sample.markers_m().array().isNaN().all());
  }
  EXPECT_TRUE(Select(hypotheses).named.empty());
}

TEST_F(HiddenObstacleIsFound, InNoHealthyRobot) {
  Measure(as_built_);
  const HypothesisSet hypotheses = Book();
  EXPECT_TRUE(Select(hypotheses).named.empty());
}

}  // namespace
}  // namespace palpate::diagnosis
