// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "libs/core/file.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/blind/generator.hpp"
#include "tests/system/blind/palpate_command.hpp"

namespace palpate::blind {

/// `palpate simulate` with something hidden in the robot, then `palpate diagnose`.
class DiagnoseVerb : public testing::Test {
 protected:
  static std::filesystem::path Source() { return PALPATE_SOURCE_DIR; }

  /// An experiment of this scenario of config/scenarios with this hidden in it.
  void Make(const std::string& effect, const std::string& of = "diagnose.yaml") {
    std::string scenario = ReadFile(Source() / "config/scenarios" / of);
    Replace(
        mesh_,
        mesh_of_truth_.empty() ? (Source() / "config/scenarios" / mesh_).string() : mesh_of_truth_,
        &scenario);
    if (!element_of_truth_.empty()) Replace("element: tet10", element_of_truth_, &scenario);
    Replace("effects: []", "effects: [" + effect + "]", &scenario);
    if (!recordings_.empty()) scenario = WithRecordings(scenario, recordings_);
    WriteFile(folder_ / "scenario.yaml", scenario);
    const auto made =
        Palpate({"simulate", robot_, "--scenario", (folder_ / "scenario.yaml").string(), "--seed",
                 seed_, "--out", (folder_ / "exp").string()},
                folder_ / "simulate.log");
    ASSERT_EQ(made, 0) << "seed " << seed_ << "\n" << ReadFile(folder_ / "simulate.log");
  }

  std::optional<int> Diagnose(const std::vector<std::string>& options = {}) {
    std::vector<std::string> words = {"diagnose", robot_,
                                      "--data",   (folder_ / "exp").string(),
                                      "--out",    (folder_ / "out").string()};
    words.insert(words.end(), options.begin(), options.end());
    return Palpate(words, folder_ / "diagnose.log");
  }
  nlohmann::json Verdict() const {
    return nlohmann::json::parse(ReadFile(folder_ / "out/verdict.json"));
  }

  test_support::TestFolder own_folder_;
  const std::filesystem::path folder_ = own_folder_.path();
  std::string robot_ = "four_leg";
  std::string mesh_ = "four_leg_coarse.msh";  ///< of the scenario
  std::string mesh_of_truth_;                 ///< in the place of that; empty: that
  std::string element_of_truth_;              ///< in the place of the scenario's, or empty
  std::set<std::string> recordings_;          ///< of the scenario; empty: all
  std::string seed_ = "7";
};

}  // namespace palpate::blind
