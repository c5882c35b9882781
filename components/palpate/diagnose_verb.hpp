// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct DiagnoseOptions {
  std::filesystem::path robot;
  std::filesystem::path data;          ///< experiment folder
  std::filesystem::path out;           ///< folder, made where it is not there
  std::string without;                 ///< ids of causes, separated by commas
  std::string explain;                 ///< id of a cause that a person wonders about
  std::string from = "all";            ///< all | markers | pictures: what of the data is looked at
  std::vector<std::string> overrides;  ///< perception.*=VALUE
  int most_samples = 120;
  int threads = 2;
  int most_minutes = 10;  ///< after which no further cause is looked for; 0: without an end
  bool plan = false;      ///< write the next experiment, too
};

/// `palpate diagnose`: writes verdict.json, report.html, robot.extended.yaml and, where drives are
/// at fault, calibration.extended.yaml, and prints the verdict; with `plan` the next experiment as
/// plan/. Data that cannot be read or cannot
/// tell have a verdict too (data_unfit). Returns 0, or 1 for data_unfit. Throws InputError where
/// the robot or the options are wrong, RunError where nothing can be written.
int Diagnose(const DiagnoseOptions& options);

app::Verb DiagnoseVerb();

}  // namespace palpate::command
