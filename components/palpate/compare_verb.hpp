// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct CompareOptions {
  std::filesystem::path estimated, truth;
  std::filesystem::path robot;          ///< empty: same_place_m
  std::vector<std::string> recordings;  ///< names; empty: all that both files have
  double same_place_m = 0.04;
  double smallest_N = 0.0;  ///< 0: a tenth of the largest true force
  double time_offset_s = 0.0;
  double same_time_s = 0.005;
  double longest_gap_s = 0.5;
  bool silence_is_no_contact = false;
  bool json = false;
};

/// `palpate compare`: the metrics of docs/force_metrics.md of one force file against another.
/// Returns 0. Throws InputError, and RunError where no time is in both.
int Compare(const CompareOptions& options);

app::Verb CompareVerb();

}  // namespace palpate::command
