// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <utility>

#include "libs/app/yaml.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// The beam of config/robots with linear elements, and one cable along its top: quick to solve.
inline robot::RobotDescription NodeTestDescription() {
  auto description = robot::ReadRobotFile(
      std::filesystem::path(PALPATE_SOURCE_DIR) / "config/robots/beam.yaml", app::LoadYaml);
  description.element = fem::ElementType::kTet4;
  description.material.poissons_ratio = 0.4;
  robot::CableSettings cable;
  cable.name = "top";
  cable.path_m.resize(3, 2);
  cable.path_m << -0.15, 0.0, 0.015, 0.015, 0.03, 0.03;
  description.cables.push_back(cable);
  return description;
}

inline std::unique_ptr<robot::RobotModel> NodeTestRobot() {
  return std::make_unique<robot::RobotModel>(robot::BuildRobotBody(NodeTestDescription()));
}

}  // namespace palpate::force_estimation
