// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/workbench.hpp"

#include "libs/core/error.hpp"

namespace palpate::benchmarks {

SensingScene& Workbench::Scene(const Contender& contender) {
  const Contender first = ModelContenders().front();
  std::unique_ptr<SensingScene>& scene = scenes_[contender.name];
  if (scene != nullptr) return *scene;
  const SensingScene::Settings settings{.solver = contender.settings};
  if (contender.name == first.name) {
    scene = std::make_unique<SensingScene>(robot_, settings);
  } else {
    scene = std::make_unique<SensingScene>(Scene(first), settings);
  }
  return *scene;
}

const fem::StiffnessMatrix& Workbench::Tangent() {
  if (tangent_) return *tangent_;
  SensingScene& scene = Scene(ModelContenders().front());
  fem::Linearisation& linearisation = scene.model().linearisation();
  const Status status = linearisation.Update(
      scene.first_state().x_m, scene.first_state().lambda_a_N, scene.external_force_N());
  if (!status.ok()) throw RunError("the state has no tangent: " + status.message());
  tangent_ = linearisation.matrix();
  scenes_.clear();
  return *tangent_;
}

SolverBench& Workbench::Solver(const Contender& contender) {
  std::unique_ptr<SolverBench>& solver = solvers_[contender.name];
  if (solver == nullptr) solver = std::make_unique<SolverBench>(contender, Tangent());
  return *solver;
}

}  // namespace palpate::benchmarks
