// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "libs/core/file.hpp"
#include "tests/system/process.hpp"

/// Diagnosis, the experiment that it asks for, and diagnosis again, on the virtual bench.
namespace palpate::blind {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kSourceFolder = PALPATE_SOURCE_DIR;

class NextExperimentLoop : public testing::Test {
 protected:
  NextExperimentLoop() : folder_(fs::temp_directory_path() / "palpate_next_experiment") {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~NextExperimentLoop() override { fs::remove_all(folder_); }

  /// config/scenarios/diagnose.yaml with an effect and some of its recordings only.
  static std::string Scenario(const std::string& effect, const std::set<std::string>& kept) {
    const std::string text = ReadFile(kSourceFolder / "config/scenarios/diagnose.yaml");
    const std::string item = "  - name: ";
    std::size_t begin = text.find(item);
    std::string scenario = text.substr(0, begin);
    const auto replace = [&](const std::string& what, const std::string& by) {
      scenario.replace(scenario.find(what), what.size(), by);
    };
    replace("effects: []", "effects: [" + effect + "]");
    replace("four_leg_coarse.msh",
            (kSourceFolder / "config/scenarios/four_leg_coarse.msh").string());
    while (begin != std::string::npos) {
      const std::size_t end = text.find(item, begin + 1);
      const std::size_t name = begin + item.size();
      const std::string recording = text.substr(name, text.find('\n', name) - name);
      if (kept.contains(recording)) scenario += text.substr(begin, end - begin);
      begin = end;
    }
    return scenario;
  }

  void Run(const std::vector<std::string>& arguments) {
    const fs::path log = folder_ / "log";
    system_test::Process process("palpate", arguments, log);
    ASSERT_EQ(process.Wait(std::chrono::seconds(600)), 0) << ReadFile(log);
  }

  /// Makes the experiment `name` and diagnoses it. The same seed: the robot and its noise stay.
  Json Diagnose(const std::string& scenario, const std::string& name) {
    const fs::path file = folder_ / (name + ".yaml");
    const fs::path data = folder_ / name;
    WriteFile(file, scenario);
    Run({"simulate", "four_leg", "--scenario", file.string(), "--seed", "7", "--out",
         data.string()});
    Run({"diagnose", "four_leg", "--data", data.string(), "--out", (data / "out").string(),
         "--samples", "30", "--plan"});
    return Json::parse(ReadFile(data / "out/verdict.json"));
  }

  fs::path folder_;
};

/// Of rho g / E displacements of cables tell the ratio alone (DIAGNOSIS, "Identities").
TEST_F(NextExperimentLoop, NamesADensityOnceTheWeightHungThatItAskedFor) {
  const std::string scenario =
      Scenario("{id: density, factor: 1.3}", {"R0_rest", "RA_east", "RA_north", "RC_pairs"});
  const Json before = Diagnose(scenario, "before");
  if (HasFatalFailure()) return;
  EXPECT_EQ(before["verdict"], "indistinguishable") << before["reason"];
  std::set<std::string> alike = {before["causes"][0]["id"]};
  for (const Json& one : before["indistinguishable_from"]) alike.insert(one["id"]);
  EXPECT_TRUE(alike.contains("density") && alike.contains("youngs_modulus"));
  EXPECT_THAT(before["next_experiment"]["by_hand"].get<std::string>(), testing::HasSubstr("hang"));
  EXPECT_GT(before["next_experiment"]["expected_ln_bayes_factor"], 3.0);
  EXPECT_THAT(ReadFile(folder_ / "before/out/plan/recording.yaml"),
              testing::HasSubstr("known_load"));
  const Json after =
      Diagnose(scenario + ReadFile(folder_ / "before/out/plan/recording.scenario.yaml"), "after");
  if (HasFatalFailure()) return;
  EXPECT_EQ(after["verdict"], "cause") << after["reason"];
  ASSERT_EQ(after["causes"].size(), 1U);
  EXPECT_EQ(after["causes"][0]["id"], "density");
  const Json& ci95 = after["causes"][0]["parameters"]["factor"]["ci95"];
  EXPECT_LT(ci95[0], 1.3);
  EXPECT_GT(ci95[1], 1.3);
}

}  // namespace
}  // namespace palpate::blind
