// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/fault_model.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/inference/fitter.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::benchmarks {

/// A healthy four_leg of the virtual bench as diagnosis sees it, and the steps that diagnosis is
/// made of.
class DiagnosedRobot {
 public:
  static constexpr int kThreads = 2;

  /// Throws RunError where `palpate simulate` fails.
  DiagnosedRobot();

  /// All moments of a robot that is a little softer, from the equilibria of the robot file's.
  void Simulate();
  /// What its modulus does, and what every parameter of every cause does.
  void DifferentiateOne();
  void DifferentiateAll();
  /// From nothing: simulates, differentiates, and compares all causes by the linear model.
  void ScreenAll();

  double ComparedSamples() const { return static_cast<double>(observed_.samples.size()); }
  double Parameters() const { return static_cast<double>(book_.parameter_count()); }

 private:
  void Differentiate(const std::vector<bool>& wanted);

  robot::RobotBody body_;
  diagnosis::ObservedExperiment observed_;
  diagnosis::HypothesisSet book_;
  diagnosis::FaultModelList causes_;
  diagnosis::Fitter fitter_;
  diagnosis::Simulator simulator_;
  diagnosis::ModelHypothesis nominal_;
  diagnosis::Simulation as_built_;
};

}  // namespace palpate::benchmarks
