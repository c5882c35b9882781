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
  std::filesystem::path data;          ///< experiment folder, or recorded messages
  std::vector<std::string> remap;      ///< FROM:=TO, of recorded messages
  std::filesystem::path calibration;   ///< whose pressure sensors correct readings; empty: none
  std::filesystem::path out;           ///< folder, made where it is not there
  std::vector<std::string> exclude;    ///< ids of causes, each element one or more ("a,b")
  std::string explain;                 ///< id of a cause; empty: none
  std::string from = "all";            ///< all | markers | depth: the data to use
  std::vector<std::string> overrides;  ///< perception.*=VALUE
  int most_samples = 120;
  int threads = 2;        ///< recordings that are processed in parallel
  int most_minutes = 10;  ///< time limit of the search; 0: unlimited
  bool plan = false;      ///< write the next experiment, too
};

/// `palpate diagnose`: writes verdict.json, report.html, robot.extended.yaml and, where actuators
/// are at fault, calibration.extended.yaml, and prints the verdict; with `plan` the next experiment
/// as plan/. Data that cannot be read or that determine nothing have a verdict, too (data_unfit).
/// Returns 0, or 1 for data_unfit. Throws InputError where the robot or an option is wrong,
/// RunError where nothing can be written. A signal ends the process (EndOnSignal).
int Diagnose(const DiagnoseOptions& options);

/// "step 2 of at most 7: fitting the null model (12 s so far; the search ends after 600 s)". Steps
/// differ in length and may be left out, so that no time to go is known. `longest_s` 0: unlimited.
std::string StepLine(int done, int of, const std::string& what, double elapsed_s, double longest_s);

app::Verb DiagnoseVerb();

}  // namespace palpate::command
