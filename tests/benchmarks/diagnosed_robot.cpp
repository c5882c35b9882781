// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/diagnosed_robot.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/inference/forward_selection.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "tests/support/robots.hpp"
#include "tests/system/blind/generator.hpp"

namespace palpate::benchmarks {

namespace {

namespace fs = std::filesystem;

experiment::Experiment MakeExperiment() {
  constexpr int kSeed = 1;
  const fs::path folder =
      fs::temp_directory_path() / ("palpate_bench_diagnosis_" + std::to_string(getpid()));
  fs::create_directories(folder);
  blind::Generator(test_support::RobotFile("four_leg"), folder)
      .Make({}, kSeed, folder / "exp", folder / "answer.json");
  experiment::Experiment experiment = experiment::ReadExperiment(folder / "exp", app::LoadYaml);
  fs::remove_all(folder);
  return experiment;
}

}  // namespace

DiagnosedRobot::DiagnosedRobot()
    : body_(robot::BuildRobotBody(test_support::FourLegRobot())),
      observed_(diagnosis::Observe(MakeExperiment(), body_)),
      book_(diagnosis::MakeFaultModels({.body = body_, .observed = observed_}, {}), {}),
      causes_(book_.All()),
      fitter_(observed_, body_, book_, {}, kThreads),
      simulator_(observed_, kThreads),
      nominal_(diagnosis::NominalHypothesis(body_, observed_)),
      as_built_(simulator_.Run(nominal_)) {
  if (!as_built_.status.ok()) throw RunError(as_built_.status.message());
}

void DiagnosedRobot::Simulate() {
  constexpr double kSofter = 0.9;
  diagnosis::ModelHypothesis draft = nominal_;
  for (auto& material : draft.body.materials) material.youngs_modulus_Pa *= kSofter;
  const diagnosis::Simulation run = simulator_.Run(draft, &as_built_);
  if (!run.status.ok()) throw RunError(run.status.message());
}

void DiagnosedRobot::Differentiate(const std::vector<bool>& wanted) {
  simulator_.Differentiate(nominal_, causes_, Eigen::VectorXd::Zero(book_.parameter_count()),
                           wanted, nominal_, &as_built_);
}

void DiagnosedRobot::DifferentiateOne() {
  std::vector<bool> wanted;
  for (const diagnosis::FaultModel* cause : causes_) {
    wanted.push_back(cause->name().id == "youngs_modulus");
  }
  Differentiate(wanted);
}

void DiagnosedRobot::DifferentiateAll() { Differentiate(std::vector<bool>(causes_.size(), true)); }

void DiagnosedRobot::ScreenAll() {
  const diagnosis::Fit as_built = fitter_.AsBuilt();
  if (diagnosis::Screen(fitter_, as_built, {}).empty()) throw RunError("no cause was screened");
}

}  // namespace palpate::benchmarks
