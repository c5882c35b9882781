// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "libs/fem/sparse/sparse_solver.hpp"

namespace palpate::fem {

/// How the linear systems of a model are solved.
struct SolverSettings {
  std::string solver = "multifrontal";  ///< one of SolverNames()
  int threads = 1;  ///< that assemble and, with multifrontal, factorise and solve; >= 1
};

/// multifrontal, cholmod_supernodal, cholmod_simplicial.
std::vector<std::string> SolverNames();

/// The solver of that name. `team` must outlive it. Throws InputError for an unknown name.
std::unique_ptr<SparseSolver> MakeSolver(const std::string& name, const BlockPattern& pattern,
                                         ThreadTeam& team);

}  // namespace palpate::fem
