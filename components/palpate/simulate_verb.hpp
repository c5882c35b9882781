// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "components/palpate/simulate/simulated_bench.hpp"
#include "libs/app/verbs.hpp"

namespace palpate::command {

struct SimulateOptions {
  std::filesystem::path robot;
  std::filesystem::path scenario;
  int seed = 1;
  std::filesystem::path out;     ///< experiment folder to make
  std::filesystem::path answer;  ///< file; empty: beside the experiment, EXP.answer.json
  std::filesystem::path check;   ///< experiment whose seal is checked; nothing is simulated
  bool tell_camera_pose = false;
};

/// `palpate simulate`: a synthetic data set with its ground truth, or the check of one
/// (--check). Returns 0; throws InputError and RunError. Tests put their own bench here.
int SimulateOrCheck(const SimulateOptions& options, const MakeBench& make_bench = MakeVirtualBench);

app::Verb SimulateVerb();

}  // namespace palpate::command
