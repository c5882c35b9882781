// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/system/blind/blind_case.hpp"
#include "tests/system/blind/verdict.hpp"

namespace palpate::blind {

/// What became of one case.
struct CaseRecord {
  std::uint64_t seed = 0;
  CaseKind kind = CaseKind::kHealthy;
  Corruption corruption = Corruption::kNone;
  std::vector<scenario::ActiveEffect> truth = {};  ///< of the opened answer
  std::vector<double> sizes_m = {};                ///< of each of them, Generator::EffectSizes_m
  std::string not_made = {};  ///< why the virtual robot could not do it; empty: it was made
  std::optional<Verdict> verdict = {};
  std::string no_verdict = {};  ///< why there is none
  double diagnosis_s = 0.0;     ///< by the clock
};

}  // namespace palpate::blind
