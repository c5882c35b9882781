// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "libs/robot/robot_model.hpp"
#include "tests/libs/robot/robot_files.hpp"

namespace palpate::robot {

/// The model of FullRobotText or of a change to it: a soft beam along y, held at y = 0, with cable
/// north above it (two eyelets) and cable south below.
class BeamModelTest : public testing::Test {
 protected:
  BeamModelTest() { WriteVtk(Beam_mm(), folder_ / "beam.vtk"); }

  std::unique_ptr<RobotModel> Build(const std::string& text,
                                    const fem::StaticSettings& settings = {}) const {
    return std::make_unique<RobotModel>(BuildRobotBody(ReadText(text, folder_ / "robot.yaml")),
                                        settings);
  }

  static ActuatorCommand Displace(double displacement_m) {
    return {ActuatorCommand::Kind::kDisplacement, displacement_m};
  }
  static ActuatorCommand Pull(double tension_N) {
    return {ActuatorCommand::Kind::kTension, tension_N};
  }

  TestFolder folder_;
};

}  // namespace palpate::robot
