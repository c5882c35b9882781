// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/blind_set.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <mutex>
#include <random>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/support/robots.hpp"
#include "tests/system/blind/blind_case.hpp"
#include "tests/system/blind/cause_menu.hpp"
#include "tests/system/blind/coarse_robot.hpp"
#include "tests/system/blind/score_table.hpp"
#include "tests/system/blind/set_folder.hpp"
#include "tests/system/blind/two_at_a_time.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;
using robot::RobotDescription;

constexpr double kLargestSeed = 2e9;

/// False: the variable is not set.
bool NumberFrom(const char* variable, double smallest, double largest, double* number) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return false;
  if (!ParseFinite(text, number) || *number != std::floor(*number) || *number < smallest ||
      *number > largest) {
    throw InputError(fmt::format("{} is '{}', not a whole number from {} to {}", variable, text,
                                 smallest, largest));
  }
  return true;
}

Measured ParseMeasured(const std::string& data) {
  if (data == "markers") return Measured::kMarkers;
  if (data == "pictures") return Measured::kPictures;
  throw InputError(
      fmt::format("PALPATE_BLIND_DATA is '{}', neither 'markers' nor 'pictures'", data));
}

CaseKind ParseKind(const std::string& text) {
  std::vector<std::string> kinds;
  for (const CaseKind kind : {CaseKind::kHealthy, CaseKind::kOneCause, CaseKind::kTwoCauses,
                              CaseKind::kOutside, CaseKind::kCorrupted}) {
    if (ToString(kind) == text) return kind;
    kinds.push_back(ToString(kind));
  }
  throw InputError(
      fmt::format("PALPATE_BLIND_KIND is '{}', none of: {}", text, fmt::join(kinds, ", ")));
}

/// On each robot causes are drawn as large as they are seen on four_leg, and those of chambers on
/// the pneumatic robots (cause_menu.hpp).
const std::vector<std::string>& Robots() {
  static const std::vector<std::string> robots = {"four_leg", "rod", "pneumatic_finger",
                                                  "pneumatic_arm"};
  return robots;
}

void TakeRobot(const std::string& robot, BlindSet* set) {
  if (robot != "each" && !IndexOf(robot, Robots()))
    throw InputError("PALPATE_BLIND_ROBOT: " + Unknown("robot", robot, Robots()));
  set->robot = robot;
}

/// How many cases of each cause; empty: causes are not chosen.
std::map<std::string, int> WantedCauses(const BlindSet& set, const RobotDescription& diagnosed) {
  std::map<std::string, int> wanted;
  if (set.cause.empty()) return wanted;
  if (set.kind && set.kind != CaseKind::kOneCause)
    throw InputError("PALPATE_BLIND_CAUSE goes with PALPATE_BLIND_KIND='one cause' alone");
  std::vector<std::string> names;
  for (const MenuItem& item : MenuFor(diagnosed)) {
    names.emplace_back(item.id);
    if (set.cause == "each" || set.cause == item.id) wanted[names.back()] = set.cases;
  }
  if (wanted.empty())
    throw InputError("PALPATE_BLIND_CAUSE: " + Unknown("cause", set.cause, names));
  return wanted;
}

/// In brackets, which cases alone.
std::string What(const BlindSet& set) {
  if (!set.cause.empty()) return " (" + set.cause + ")";
  return set.kind ? " (" + ToString(*set.kind) + ")" : "";
}

std::vector<CaseRecord> RunRobot(const BlindSet& set, std::ostream& out) {
  const SetFolder folder(set.folder);
  const fs::path robot_file = IsCoarse(set.robot) ? WriteCoarseRobot(set.robot, folder.path())
                                                  : test_support::RobotFile(set.robot);
  const std::vector<std::uint64_t> seeds =
      set.Seeds(robot::ReadRobotFile(robot_file, app::LoadYaml));
  fmt::print(out,
             "{} blind cases of {}{} of {} from seed {} on, {} moments each; one again: "
             "PALPATE_BLIND_SEED=<its seed> PALPATE_BLIND_CASES=1\n",
             seeds.size(), set.robot, What(set),
             set.measured == Measured::kPictures ? "pictures" : "markers", set.seed, set.samples);
  const CaseRunner runner({.robot_file = robot_file,
                           .folder = folder.path(),
                           .keep = folder.keeps(),
                           .measured = set.measured,
                           .samples = set.samples,
                           .minutes = set.minutes});
  std::vector<CaseRecord> records(seeds.size());
  std::mutex printing;
  TwoAtATime([&](std::size_t i) {
    if (i >= records.size()) return false;
    records[i] = runner.Run(seeds[i]);
    const std::lock_guard lock(printing);
    PrintCase(out, records[i]);
    return true;
  });
  PrintScore(out, Judge(records));
  return records;
}

}  // namespace

BlindSet BlindSet::FromEnvironment(int cases) {
  BlindSet set{.cases = cases, .seed = std::random_device()() % 1000000000u};
  double number = 0.0;
  if (NumberFrom("PALPATE_BLIND_CASES", 1.0, 1e5, &number)) set.cases = static_cast<int>(number);
  if (NumberFrom("PALPATE_BLIND_SEED", 0.0, kLargestSeed, &number)) {
    set.seed = static_cast<std::uint64_t>(number);
  }
  if (NumberFrom("PALPATE_BLIND_SAMPLES", 10.0, 2000.0, &number)) {
    set.samples = static_cast<int>(number);
  }
  if (const char* folder = std::getenv("PALPATE_BLIND_FOLDER")) set.folder = folder;
  if (const char* data = std::getenv("PALPATE_BLIND_DATA")) set.measured = ParseMeasured(data);
  if (const char* kind = std::getenv("PALPATE_BLIND_KIND")) set.kind = ParseKind(kind);
  if (const char* cause = std::getenv("PALPATE_BLIND_CAUSE")) set.cause = cause;
  if (const char* robot = std::getenv("PALPATE_BLIND_ROBOT")) TakeRobot(robot, &set);
  return set;
}

std::vector<std::uint64_t> BlindSet::Seeds(const RobotDescription& diagnosed) const {
  std::map<std::string, int> wanted = WantedCauses(*this, diagnosed);
  const auto is_asked_for = [&](std::uint64_t next) {
    if (kind && KindOf(next) != *kind) return false;
    if (wanted.empty()) return true;
    if (KindOf(next) != CaseKind::kOneCause) return false;
    const auto hides = wanted.find(DrawCase(next, diagnosed, measured).effects.front().id);
    return hides != wanted.end() && hides->second-- > 0;
  };
  const std::size_t count = At(cases) * std::max<std::size_t>(1, wanted.size());
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t next = seed; seeds.size() < count; ++next) {
    if (is_asked_for(next)) seeds.push_back(next);
  }
  return seeds;
}

std::vector<BlindSet> BlindSet::OfRobots() const {
  if (robot != "each") return {*this};
  std::vector<BlindSet> sets;
  for (const std::string& one : Robots()) {
    sets.push_back(*this);
    sets.back().robot = one;
    if (!folder.empty()) sets.back().folder = folder / one;
  }
  return sets;
}

std::vector<CaseRecord> RunBlind(const BlindSet& set, std::ostream& out) {
  std::vector<CaseRecord> all;
  for (const BlindSet& of_robot : set.OfRobots()) {
    const std::vector<CaseRecord> records = RunRobot(of_robot, out);
    all.insert(all.end(), records.begin(), records.end());
  }
  return all;
}

}  // namespace palpate::blind
