// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {

/// Of the parameter's fault sigma, over which nothing bends by more than about its own size: over
/// this, by 1e-6 of it (central), still far above where the solver stops.
inline constexpr double kStep = 1e-3;
/// What is found by steps that end at 1e-8 rad needs a longer one.
inline constexpr double kStepOfBase = 1e-2;
/// A node begins to press on an obstacle over some micrometres.
inline constexpr double kStepOfObstacle = 3e-5;
/// What a whole fault sigma moves all markers by that counts as none.
inline constexpr double kNothing_m = 1e-6;

/// Of each sample the frame in its middle: means have derivatives of their own.
inline ObservedExperiment SingleFrames(ObservedExperiment observed) {
  for (Sample& sample : observed.samples) sample.frame_t_s = {sample.t_s};
  return observed;
}

/// Adds what depth frames show.
using Seeing = std::function<void(const robot::RobotBody&, ObservedExperiment*)>;

/// The derivatives that faults tell of what is seen of a small robot, against differences of
/// simulations.
class FaultDerivatives : public testing::Test {
 protected:
  FaultDerivatives() : FaultDerivatives(SmallRobot(), SmallExperiment(SmallRobot())) {}
  FaultDerivatives(const robot::RobotBody& body, const experiment::Experiment& experiment,
                   const Seeing& seeing = nullptr, bool with_mesh_error = true)
      : with_mesh_error_(with_mesh_error),
        body_(body),
        observed_(SingleFrames(
            Observe(experiment, body_, {.most_samples = 14, .depth_cameras = SmallCameras()}))) {
    if (!seeing) return;
    seeing(body_, &observed_);
    Begin();
  }

  /// As the robot file has it.
  void Begin() {
    each_ = observed_.CoordinateCount();
    nominal_ = NominalHypothesis(body_, observed_);
    at_rest_ = simulator_.Run(nominal_);
    causes_ = Causes();
  }

  /// The mesh of SmallRobot in tet4 is known to err.
  std::vector<FaultModelPtr> Causes() const {
    CatalogueInputs world{.body = body_, .observed = observed_, .as_built = &at_rest_};
    if (with_mesh_error_ && body_.mesh.element_type() == fem::ElementType::kTet4) {
      const robot::RobotBody finer = SmallRobotOnFinerMesh();
      const Simulation on_finer = Simulator(observed_, 1).Run(NominalHypothesis(finer, observed_));
      world.mesh_error =
          std::make_shared<MeshError>(CompareMeshes(body_, at_rest_, finer, on_finer).value());
    }
    std::vector<FaultModelPtr> causes = MakeFaultModels(world, {});
    // It changes nothing that is simulated (model_discrepancy_test.cpp).
    std::erase_if(causes, [](const FaultModelPtr& one) { return one->AddsToPrediction(); });
    return causes;
  }

  /// [coordinates, samples after another] of the simulation.
  Eigen::VectorXd Markers(const FaultModelList& causes, const Eigen::VectorXd& z) const {
    const Simulation run = simulator_.Run(HypothesisWith(nominal_, causes, z), &at_rest_);
    EXPECT_TRUE(run.status.ok()) << run.status.message();
    Eigen::VectorXd all_m(each_ * std::ssize(run.samples));
    for (Eigen::Index s = 0; s < std::ssize(run.samples); ++s) {
      const Eigen::VectorXd& seen_m = run.samples[static_cast<std::size_t>(s)].seen_m;
      all_m.segment(each_ * s, each_) = seen_m.array().isNaN().select(0.0, seen_m);
    }
    return all_m;
  }

  Eigen::MatrixXd Analytic(const FaultModelList& causes, const Eigen::VectorXd& z) const {
    const ModelHypothesis hypothesis = HypothesisWith(nominal_, causes, z);
    Simulation run = simulator_.Run(hypothesis, &at_rest_);
    simulator_.Differentiate(hypothesis, causes, z, std::vector<bool>(causes.size(), true),
                             nominal_, &run);
    simulator_.DifferentiateBySimulation(nominal_, causes, z, &run);
    Eigen::MatrixXd all_m(each_ * std::ssize(run.samples), z.size());
    for (Eigen::Index s = 0; s < std::ssize(run.samples); ++s) {
      all_m.middleRows(each_ * s, each_) = run.samples[static_cast<std::size_t>(s)].jacobian_m;
    }
    return all_m;
  }

  /// Central; one-sided of second order where the parameter cannot be below.
  static double StepOf(const FaultParameter& parameter) {
    if (parameter.name == "compliance_rad_Nm") return kStepOfBase;
    const bool of_wall = parameter.name == "farther_m" || parameter.name.starts_with("tilt_");
    return of_wall ? kStepOfObstacle : kStep;
  }

  Eigen::VectorXd Difference(const FaultModelList& causes, const Eigen::VectorXd& z, Eigen::Index p,
                             const FaultParameter& parameter) const {
    const double h = StepOf(parameter) * parameter.fault;
    const auto at = [&](double steps) {
      Eigen::VectorXd beside = z;
      beside[p] += steps * h;
      return Markers(causes, beside);
    };
    if (z[p] - h < parameter.least) return (4.0 * at(1.0) - 3.0 * at(0.0) - at(2.0)) / (2.0 * h);
    return (at(1.0) - at(-1.0)) / (2.0 * h);
  }

  /// The worst recording: what is small beside another must be right, too, down to a share of all
  /// recordings together, or of `whole_m` where that is more.
  struct Mismatch {
    double relative = 0.0;
    std::string where;
  };
  Mismatch Compare(const Eigen::VectorXd& analytic, const Eigen::VectorXd& difference,
                   double least_share, double whole_m = 0.0) const {
    Mismatch worst;
    for (int r = 0; r < std::ssize(observed_.recordings); ++r) {
      double off = 0.0;
      double size = 0.0;
      for (Eigen::Index s = 0; s < std::ssize(observed_.samples); ++s) {
        if (observed_.samples[static_cast<std::size_t>(s)].recording != r) continue;
        off += (analytic - difference).segment(each_ * s, each_).squaredNorm();
        size += difference.segment(each_ * s, each_).squaredNorm();
      }
      const double floor_m = least_share * std::max(difference.norm(), whole_m) + kNothing_m;
      const double relative = std::sqrt(off) / std::max(std::sqrt(size), floor_m);
      if (relative <= worst.relative) continue;
      worst = {relative, observed_.recordings[static_cast<std::size_t>(r)].name + ", of " +
                             std::to_string(1e3 * std::sqrt(size)) + " mm"};
    }
    return worst;
  }

  void ExpectAlike(const Eigen::VectorXd& analytic, const Eigen::VectorXd& difference,
                   double tolerance, const std::string& what, double least_share = 1e-3,
                   double whole_m = 0.0) const {
    const Mismatch worst = Compare(analytic, difference, least_share, whole_m);
    EXPECT_LE(worst.relative, tolerance) << what << " in " << worst.where;
  }

  /// Whether there is an obstacle is no matter of degree: hidden_obstacle_test.cpp.
  void ExpectDerivative(const FaultModel& cause, const Eigen::VectorXd& z, double tolerance,
                        double least_share = 1e-3) const {
    const FaultModelList one{&cause};
    const Eigen::MatrixXd analytic = Analytic(one, z);
    // Where softening is far from its end m says nothing, and its column is what the last share of
    // the pasts leaves: of that of the softening.
    double whole_m = 0.0;
    for (Eigen::Index p = cause.name().id == "hidden_obstacle" ? 1 : 0; p < z.size(); ++p) {
      const FaultParameter& parameter = cause.parameters()[static_cast<std::size_t>(p)];
      const Eigen::VectorXd difference = parameter.fault * Difference(one, z, p, parameter);
      if (cause.name().id == "mullins" && cause.NeedsSimulation(z))
        whole_m = std::max(whole_m, difference.norm());
      ExpectAlike(parameter.fault * analytic.col(p), difference, tolerance,
                  cause.words() + ", " + parameter.name, least_share, whole_m);
    }
  }

  /// Where a hold follows a pull next to nothing is softer than it was, and pasts are not settled
  /// to that.
  static double LeastShare(const std::string& id) { return id == "mullins" ? 1.0 : 1e-3; }

  void ExpectDerivativesAsBuilt() const {
    ASSERT_TRUE(at_rest_.status.ok()) << at_rest_.status.message();
    constexpr double kTolerance = 2e-3;
    constexpr double kToleranceOfDamage = 4e-3;  // the difference is one-sided and bends most
    for (const FaultModelPtr& cause : causes_) {
      const std::string& id = cause->name().id;
      if (id == "stiffening") continue;       // begins with another material
      if (id == "hidden_obstacle") continue;  // its directions exist only once it is there
      ExpectDerivative(*cause, Eigen::VectorXd::Zero(std::ssize(cause->parameters())),
                       id == "mullins" ? kToleranceOfDamage : kTolerance, LeastShare(id));
    }
  }

  bool with_mesh_error_;
  robot::RobotBody body_;
  ObservedExperiment observed_;
  Eigen::Index each_ = observed_.CoordinateCount();
  ModelHypothesis nominal_ = NominalHypothesis(body_, observed_);
  Simulator simulator_{observed_, 1};
  Simulation at_rest_ = simulator_.Run(nominal_);
  std::vector<FaultModelPtr> causes_ = Causes();
};

}  // namespace palpate::diagnosis
