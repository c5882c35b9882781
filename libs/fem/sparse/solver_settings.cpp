// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/solver_settings.hpp"

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::fem {

namespace {

constexpr const char* kMultifrontal = "multifrontal";
constexpr const char* kCholmodSupernodal = "cholmod_supernodal";
constexpr const char* kCholmodSimplicial = "cholmod_simplicial";

}  // namespace

std::vector<std::string> SolverNames() {
  return {kMultifrontal, kCholmodSupernodal, kCholmodSimplicial};
}

std::unique_ptr<SparseSolver> MakeSolver(const std::string& name, const BlockPattern& pattern,
                                         ThreadTeam& team) {
  if (name == kMultifrontal) return MakeMultifrontalSolver(pattern, team);
  if (name == kCholmodSupernodal) return MakeCholmodSolver(pattern, CholmodMethod::kSupernodal);
  if (name == kCholmodSimplicial) return MakeCholmodSolver(pattern, CholmodMethod::kSimplicial);
  throw InputError("no solver '" + name + "'" + DidYouMean(name, SolverNames()));
}

}  // namespace palpate::fem
