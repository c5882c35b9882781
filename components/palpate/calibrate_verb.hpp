// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/verbs.hpp"
#include "libs/fem/sparse/solver_settings.hpp"

namespace palpate::command {

struct CalibrateOptions {
  std::filesystem::path robot;
  std::string what = "material";
  std::filesystem::path data;           ///< experiment or recording folder
  std::vector<std::string> recordings;  ///< names; empty: all with a static phase and known loads
  std::vector<std::string> parts;       ///< "body" or names of regions; empty: the body
  std::string cable_input = "displacement";
  fem::SolverSettings solver;
  double marker_bias_m = 0.0;  ///< constant error of each marker, one sigma
  std::filesystem::path out;
  bool json = false;
};

/// `palpate calibrate`: fits Young's moduli to static phases with known loads or self weight and
/// writes the calibration file. Returns 0, or 1 where the data do not determine the moduli; throws
/// InputError and RunError.
int Calibrate(const CalibrateOptions& options);

app::Verb CalibrateVerb();

}  // namespace palpate::command
