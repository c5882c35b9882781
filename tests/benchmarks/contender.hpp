// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "libs/fem/sparse/solver_settings.hpp"

namespace palpate::benchmarks {

/// A sparse solver that is compared with the others.
struct Contender {
  std::string name;  ///< last part of the names of its benchmarks
  fem::SolverSettings settings;
  /// Works on single entries instead of dense blocks, so that a large mesh takes long.
  bool by_entries = false;
};

/// Solvers that a model can use, ours with one thread first.
std::vector<Contender> ModelContenders();
/// Those, and Eigen's LDLT.
std::vector<Contender> AllContenders();

/// The solver of that contender; `team`, of as many threads as its settings say, must outlive it.
std::unique_ptr<fem::SparseSolver> MakeContender(const Contender& contender,
                                                 const fem::BlockPattern& pattern,
                                                 ThreadTeam& team);

}  // namespace palpate::benchmarks
