// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/plan_runner.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/recording.hpp"
#include "tests/system/blind/blind_case.hpp"
#include "tests/system/blind/generator.hpp"
#include "tests/system/process.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kLongestDiagnosis(600);

/// What weight, stiffness, shape and what pulls at the body have in common: without a weight hung
/// or a base tilted one of them often does what another does.
const std::set<std::string_view> kOftenAlike = {"youngs_modulus",    "density", "plastic_set",
                                                "gravity_direction", "payload", "permanent_force"};
/// Two cables alone, and together.
const std::set<std::string> kFewRecordings = {"R0_rest", "RA_east", "RA_north", "RC_pairs"};

scenario::ActiveEffect DrawAmbiguous(const robot::RobotDescription& robot,
                                     scenario::Random* random) {
  std::vector<MenuItem> menu = CauseMenu();
  std::erase_if(menu, [](const MenuItem& item) { return !kOftenAlike.contains(item.id); });
  return DrawEffect(menu[random->Below(menu.size())], robot, random);
}

bool IsSeparated(const Verdict& verdict, const scenario::ActiveEffect& effect) {
  return !verdict.causes.empty() && verdict.causes.front().Names(effect) &&
         verdict.indistinguishable_from.empty();
}

/// The folders of what was planned, the best first.
std::vector<fs::path> PlansIn(const fs::path& out) {
  std::vector<fs::path> plans;
  if (fs::exists(out / "plan_others")) {
    for (const auto& entry : fs::directory_iterator(out / "plan_others")) plans.push_back(entry);
  }
  std::sort(plans.begin(), plans.end());
  if (fs::exists(out / "plan/recording.yaml")) plans.insert(plans.begin(), out / "plan");
  return plans;
}

}  // namespace

PlanRunner::PlanRunner(Settings settings)
    : settings_(std::move(settings)),
      robot_(robot::ReadRobotFile(settings_.robot_file, app::LoadYaml)) {}

PlanRecord PlanRunner::Run(std::uint64_t seed) const {
  scenario::Random random(seed, "planned experiment");
  PlanRecord record{.seed = seed, .effect = DrawAmbiguous(robot_, &random)};
  const fs::path folder = settings_.folder / ("plan" + std::to_string(seed));
  fs::remove_all(folder);
  fs::create_directories(folder);
  Generator generator(settings_.robot_file, folder);
  generator.Keep(kFewRecordings);
  const auto made_and_diagnosed = [&](const std::string& name, const std::string& further) {
    generator.Make({record.effect}, seed, folder / name, folder / (name + ".answer.json"), further);
    return Diagnose(folder / name, folder / (name + "_out"));
  };
  const Verdict few = made_and_diagnosed("few", "");
  const std::vector<fs::path> plans = PlansIn(folder / "few_out");
  record.ranked = static_cast<int>(plans.size());
  if (IsSeparated(few, record.effect)) record.no_question = "it is named, nothing fits as well";
  if (plans.empty()) record.no_question = "none is asked after " + few.verdict;
  if (!record.no_question.empty()) return record;
  const auto outcome = [&](const std::string& name, std::size_t k) -> PlanOutcome {
    const std::string further = ReadFile(plans[k] / "recording.scenario.yaml");
    return {.title = experiment::ReadRecording(plans[k], app::LoadYaml).notes,
            .rank = static_cast<int>(k) + 1,
            .separated = IsSeparated(made_and_diagnosed(name, further), record.effect)};
  };
  record.proposed = outcome("proposed", 0);
  const std::size_t drawn = random.Below(plans.size());
  record.drawn = drawn == 0 ? record.proposed : outcome("drawn", drawn);
  return record;
}

Verdict PlanRunner::Diagnose(const fs::path& data, const fs::path& out) const {
  const fs::path log = out.string() + ".log";
  system_test::Process program(
      "palpate",
      {"diagnose", settings_.robot_file.string(), "--data", data.string(), "--out", out.string(),
       "--samples", std::to_string(settings_.samples), "--plan"},
      log);
  if (program.Wait(kLongestDiagnosis) != 0) throw RunError("palpate diagnose: " + ReadFile(log));
  return ReadVerdict(out / "verdict.json");
}

}  // namespace palpate::blind
