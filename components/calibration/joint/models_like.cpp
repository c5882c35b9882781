// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/models_like.hpp"

namespace palpate::calibration {

std::vector<std::unique_ptr<robot::RobotModel>> ModelsLike(robot::RobotModel& model, int count) {
  std::vector<std::unique_ptr<robot::RobotModel>> models;
  fem::SolverSettings solver;
  for (const std::string& name : fem::SolverNames()) {
    if (model.linearisation().solver().Name().starts_with(name)) solver.solver = name;
  }
  for (int k = 0; k < count; ++k) {
    models.push_back(
        std::make_unique<robot::RobotModel>(model.body(), fem::StaticSettings(), solver));
    for (int c = 0; c < model.CableCount(); ++c) {
      models.back()->SetCableFriction(c, model.cable(c).friction());
      models.back()->SetPullPoint(c, model.cable(c).pull_point_m());
    }
  }
  return models;
}

}  // namespace palpate::calibration
