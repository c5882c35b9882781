// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/palpate/simulate_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/experiment.hpp"
#include "tests/components/palpate/fake_bench.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {

inline const std::string kCamera =
    "camera:\n  depth: {width_px: 4, height_px: 3, fx_px: 3, fy_px: 3, cx_px: 1.5, cy_px: 1, "
    "unit_m: 0.001, baseline_m: 0.05}\n  color: {width_px: 4, height_px: 3, fx_px: 3, fy_px: 3, "
    "cx_px: 1.5, cy_px: 1, registered_to_depth: true}\n  eye_m: [0, -1, 0]\n  target_m: [0, 0, 0]\n"
    "  rate_hz: 4\n";
inline const std::string kMarkers = "markers: {sigma_m: [1.0e-4, 2.0e-4, 3.0e-4], rate_hz: 10}\n";
inline const std::string kRecordings =
    "tools: [{name: ball, shape: sphere, radius_m: 0.01}]\n"
    "rest_between_s: 0.5\n"
    "recordings:\n"
    "  - name: a_rest\n    kind: rest\n    duration_s: 0.3\n"
    "  - name: b_pull\n    kind: ramp\n    duration_s: 1\n    notes: up\n"
    "    commands: [{t_s: 0, top.displacement_m: 0}, {t_s: 0.75, top.displacement_m: 0.003}, {t_s: "
    "1, "
    "top.displacement_m: 0.003}]\n"
    "    tools: [{tool: ball, path: [{t_s: 0, position_m: [0, 0, 1]}]}]\n"
    "    weights: [{t_s: 0.25, position_m: [0.08, 0.01, 0.02], mass_kg: 0.01}]\n"
    "    base_tilt_deg: [90, 0]\n";

/// `palpate simulate` with a bench that is none, in a folder with a robot and a scenario.
class SimulateTest : public testing::Test {
 protected:
  SimulateTest() {
    options_.robot = WriteBarRobot(folder_);
    options_.out = folder_ / "exp";
    Scenario(kMarkers + kRecordings);
  }

  void Scenario(const std::string& text) {
    options_.scenario = folder_.Write("s.yaml", "name: hidden_truth\n" + text);
  }
  int Run() { return SimulateOrCheck(options_, FakesWith(&log_)); }
  experiment::Experiment Read() const {
    return experiment::ReadExperiment(options_.out, app::LoadYaml);
  }
  std::string AnswerText() const { return ReadFile(folder_ / "exp.answer.json"); }
  nlohmann::json AnswerJson() const { return nlohmann::json::parse(AnswerText()); }

  template <typename Error = InputError>
  std::string Refusal() {
    try {
      Run();
    } catch (const Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }
  int Check() {
    SimulateOptions check;
    check.check = options_.out;
    return SimulateOrCheck(check);
  }
  template <typename Error>
  std::string CheckRefusal() {
    try {
      Check();
    } catch (const Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }
  std::vector<std::string> FilesOf(const std::filesystem::path& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      names.push_back(entry.path().lexically_relative(folder).generic_string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  TestFolder folder_;
  SimulateOptions options_;
  FakeBenchLog log_;
};

}  // namespace palpate::command
