// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "libs/app/verbs.hpp"
#include "libs/fem/sparse/solver_settings.hpp"

namespace palpate::command {

struct SolveOptions {
  std::filesystem::path robot = "four_leg";
  std::filesystem::path actuation;  ///< empty: no cable is actuated
  std::filesystem::path loads;      ///< empty: no external load
  std::filesystem::path out;
  std::string cable_input = "displacement";  ///< or "tension": prescribed on a cable with both
  fem::SolverSettings solver;
  bool vtu = false;   ///< write body_0000.vtu, cables_0000.vtu and body.pvd
  bool png = false;   ///< write scene_0000.png
  bool json = false;  ///< print result.json instead of text
};

/// `palpate solve`: static equilibria, one for each row of the actuation. Returns 0 only if all
/// rows converged, else 1; throws InputError and RunError, and app::Interrupted once the rows that
/// were solved before a signal are written.
int Solve(const SolveOptions& options);

app::Verb SolveVerb();

}  // namespace palpate::command
