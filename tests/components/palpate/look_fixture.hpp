// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/simulate_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/components/palpate/test_robot.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/scenarios.hpp"

namespace palpate::command {

/// Two settings of the cables.
inline const std::string kTwoHolds =
    "rest_between_s: 0.5\nrecordings:\n" +
    test_support::Hold("a_hold", 0.1, {0.004, 0.006, 0.008, 0.004}) +
    test_support::Hold("b_hold", 0.1, {0.008, 0.004, 0.004, 0.006});

/// The four legs of a coarse mesh, simulated, and `palpate calibrate --what camera` over what a
/// camera saw of them.
class LookTest : public testing::Test {
 protected:
  LookTest() {
    robot_text_ = ReadFile(PALPATE_SOURCE_DIR "/config/robots/four_leg.yaml");
    Replace("file: four_leg.msh", "file: " + Mesh(), &robot_text_);
    Replace("element: tet10", "element: tet4", &robot_text_);
    options_.robot = folder_.Write("robot.yaml", robot_text_);
    options_.data = folder_ / "exp";
    options_.out = folder_ / "calibration.yaml";
    options_.what = "camera";
  }

  static std::string Mesh() { return test_support::CoarseFourLegMesh().string(); }

  static void Replace(const std::string& old, const std::string& by, std::string* text) {
    ASSERT_NE(text->find(old), std::string::npos) << old;
    text->replace(text->find(old), old.size(), by);
  }

  /// `scene`: camera, stage and recordings of the scenario.
  void SimulateScene(const std::string& scene) const {
    SimulateOptions simulate;
    simulate.robot = options_.robot;
    simulate.scenario =
        folder_.Write("s.yaml", "name: look\nbody: {mesh_file: " + Mesh() +
                                    ", refine: 0, element: tet4}\nmotion: {mode: quasi_static, "
                                    "time_step_s: 0.1}\nclutter: 0\n" +
                                    scene);
    simulate.seed = 3;
    simulate.out = options_.data;
    ASSERT_EQ(SimulateOrCheck(simulate), 0);
  }

  robot::CalibrationFile Found() const {
    return robot::ReadCalibrationFile(options_.out, app::LoadYaml);
  }

  template <typename Error>
  std::string Refusal() const {
    try {
      Calibrate(options_);
    } catch (const Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }

  TestFolder folder_;
  std::string robot_text_;
  CalibrateOptions options_;
};

}  // namespace palpate::command
