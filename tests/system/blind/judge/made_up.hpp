// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "libs/robot/robot_description.hpp"
#include "tests/support/robots.hpp"
#include "tests/system/blind/case_runner.hpp"
#include "tests/system/blind/parameter_errors.hpp"

/// Cases as they are drawn, judged without data: the verdicts are made up.
namespace palpate::blind {

/// As the name of the cause, right to 1 % with intervals of 5 %.
inline Suspect Accused(const scenario::ActiveEffect& effect, double probability = 0.97) {
  Suspect suspect{.id = effect.id, .where = effect.where, .probability = probability};
  for (const auto& [name, drawn] : effect.parameters) {
    const double value = WhatIsToTell(name, drawn);
    const double wide = 0.05 * std::abs(value);
    suspect.parameters[name] = {1.01 * value, value - wide, value + wide};
  }
  return suspect;
}

/// What somebody says who knows the answer.
inline Verdict RightVerdict(const CaseRecord& record) {
  Verdict verdict{.verdict = "no_fault"};
  if (record.kind == CaseKind::kCorrupted) verdict.verdict = "data_unfit";
  if (record.kind == CaseKind::kOutside) verdict.verdict = "unexplained";
  if (record.kind == CaseKind::kOneCause || record.kind == CaseKind::kTwoCauses) {
    verdict.verdict = "cause";
    for (const auto& effect : record.truth) verdict.causes.push_back(Accused(effect));
  }
  verdict.residuals_m = {.before = 1.3e-3, .heldout_after = 5.1e-4, .noise = 5e-4};
  return verdict;
}

/// `count` cases of seeds from `seed` on, every effect of 1 mm, without verdicts.
inline std::vector<CaseRecord> DrawnRecords(std::uint64_t seed, int count) {
  const robot::RobotDescription robot = test_support::FourLegRobot();
  std::vector<CaseRecord> records;
  for (int i = 0; i < count; ++i) {
    const BlindCase drawn = DrawCase(seed + static_cast<std::uint64_t>(i), robot);
    records.push_back({.seed = drawn.seed,
                       .kind = drawn.kind,
                       .corruption = drawn.corruption,
                       .truth = drawn.effects,
                       .sizes_m = std::vector<double>(drawn.effects.size(), 1e-3)});
  }
  return records;
}

inline std::vector<CaseRecord> RightRecords(std::uint64_t seed, int count) {
  std::vector<CaseRecord> records = DrawnRecords(seed, count);
  for (CaseRecord& record : records) record.verdict = RightVerdict(record);
  return records;
}

}  // namespace palpate::blind
