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
#include "tests/support/test_folder.hpp"
#include "tests/system/blind/generator.hpp"
#include "tests/system/process.hpp"

/// Diagnosis, the experiment that it asks for, and diagnosis again, on the virtual bench.
namespace palpate::blind {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kSourceFolder = PALPATE_SOURCE_DIR;

class NextExperimentLoop : public testing::Test {
 protected:
  void Run(const std::vector<std::string>& arguments) {
    const fs::path log = folder_ / "log";
    system_test::Process process("palpate", arguments, log);
    ASSERT_EQ(process.Wait(std::chrono::seconds(600)), 0) << ReadFile(log);
  }

  /// Makes the experiment `name` of a heavy robot, `further` recordings in it, and diagnoses it.
  /// The same seed: the robot and its noise stay.
  Json Diagnose(const std::string& further, const std::string& name) {
    constexpr std::uint64_t kSeed = 7;
    Generator generator(kSourceFolder / "config/robots/four_leg.yaml", folder_);
    generator.Keep({"R0_rest", "RA_east", "RA_north", "RC_pairs"});
    const fs::path data = folder_ / name;
    generator.Make({{"density", {"body"}, {{"factor", kFactor}}}}, kSeed, data,
                   folder_ / (name + ".answer.json"), further);
    Run({"diagnose", "four_leg", "--data", data.string(), "--out", (data / "out").string(),
         "--samples", "30", "--plan"});
    return Json::parse(ReadFile(data / "out/verdict.json"));
  }

  static constexpr double kFactor = 1.3;
  test_support::TestFolder own_folder_;
  const fs::path folder_ = own_folder_.path();
};

/// Without a known load, displacements of cables determine rho g / E only
/// (components/diagnosis/explain/identities.hpp).
TEST_F(NextExperimentLoop, NamesADensityOnceTheWeightHungThatItAskedFor) {
  const Json before = Diagnose("", "before");
  if (HasFatalFailure()) return;
  EXPECT_EQ(before["verdict"], "indistinguishable") << before["reason"];
  std::set<std::string> alike = {before["causes"][0]["id"]};
  for (const Json& one : before["indistinguishable_from"]) alike.insert(one["id"]);
  EXPECT_TRUE(alike.contains("density") && alike.contains("youngs_modulus"));
  EXPECT_THAT(before["next_experiment"]["by_hand"].get<std::string>(), testing::HasSubstr("hang"));
  EXPECT_GT(before["next_experiment"]["expected_ln_bayes_factor"], 3.0);
  EXPECT_THAT(ReadFile(folder_ / "before/out/plan/recording.yaml"),
              testing::HasSubstr("known_load"));
  const std::size_t others = before["next_experiment"]["others"].size();
  EXPECT_GT(others, 10U);
  EXPECT_EQ(others, static_cast<std::size_t>(std::distance(
                        fs::directory_iterator(folder_ / "before/out/plan_others"), {})));
  const Json after =
      Diagnose(ReadFile(folder_ / "before/out/plan/recording.scenario.yaml"), "after");
  if (HasFatalFailure()) return;
  EXPECT_EQ(after["verdict"], "cause") << after["reason"];
  ASSERT_EQ(after["causes"].size(), 1U);
  EXPECT_EQ(after["causes"][0]["id"], "density");
  const Json& ci95 = after["causes"][0]["parameters"]["factor"]["ci95"];
  EXPECT_LT(ci95[0], kFactor);
  EXPECT_GT(ci95[1], kFactor);
}

}  // namespace
}  // namespace palpate::blind
