// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/blind_set.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <random>

#include "libs/core/error.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "tests/support/robots.hpp"
#include "tests/system/blind/coarse_robot.hpp"
#include "tests/system/blind/score_table.hpp"
#include "tests/system/blind/set_folder.hpp"
#include "tests/system/blind/two_at_a_time.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;

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
void TakeRobot(const std::string& robot, BlindSet* set) {
  const std::vector<std::string> robots = {"four_leg", "rod", "pneumatic_finger", "pneumatic_arm"};
  if (!IndexOf(robot, robots))
    throw InputError("PALPATE_BLIND_ROBOT: " + Unknown("robot", robot, robots));
  set->robot = robot;
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
  if (const char* robot = std::getenv("PALPATE_BLIND_ROBOT")) TakeRobot(robot, &set);
  return set;
}

std::vector<std::uint64_t> BlindSet::Seeds() const {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t next = seed; std::ssize(seeds) < cases; ++next) {
    if (!kind || KindOf(next) == *kind) seeds.push_back(next);
  }
  return seeds;
}

std::vector<CaseRecord> RunBlind(const BlindSet& set, std::ostream& out) {
  fmt::print(out,
             "{} blind cases of {}{} of {} from seed {} on, {} moments each; one again: "
             "PALPATE_BLIND_SEED=<its seed> PALPATE_BLIND_CASES=1\n",
             set.cases, set.robot, set.kind ? " (" + ToString(*set.kind) + ")" : "",
             set.measured == Measured::kPictures ? "pictures" : "markers", set.seed, set.samples);
  const SetFolder folder(set.folder);
  const CaseRunner runner({.robot_file = IsCoarse(set.robot)
                                             ? WriteCoarseRobot(set.robot, folder.path())
                                             : test_support::RobotFile(set.robot),
                           .folder = folder.path(),
                           .keep = folder.keeps(),
                           .measured = set.measured,
                           .samples = set.samples,
                           .minutes = set.minutes});
  const std::vector<std::uint64_t> seeds = set.Seeds();
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

}  // namespace palpate::blind
