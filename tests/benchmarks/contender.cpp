// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/contender.hpp"

#include "tests/benchmarks/eigen_ldlt.hpp"

namespace palpate::benchmarks {

namespace {

constexpr const char* kEigenLdlt = "eigen_ldlt";

}  // namespace

std::vector<Contender> ModelContenders() {
  const auto alone = [](const std::string& solver) {
    return fem::SolverSettings{.solver = solver, .threads = 1};
  };
  return {
      {.name = "multifrontal", .settings = alone("multifrontal")},
      {.name = "multifrontal_2_threads", .settings = {.solver = "multifrontal", .threads = 2}},
      {.name = "cholmod_supernodal", .settings = alone("cholmod_supernodal")},
      {.name = "cholmod_simplicial", .settings = alone("cholmod_simplicial"), .by_entries = true}};
}

std::vector<Contender> AllContenders() {
  std::vector<Contender> contenders = ModelContenders();
  contenders.push_back(
      {.name = kEigenLdlt, .settings = {.solver = kEigenLdlt, .threads = 1}, .by_entries = true});
  return contenders;
}

std::unique_ptr<fem::SparseSolver> MakeContender(const Contender& contender,
                                                 const fem::BlockPattern& pattern,
                                                 ThreadTeam& team) {
  if (contender.name == kEigenLdlt) return MakeEigenLdlt(pattern);
  return fem::MakeSolver(contender.settings.solver, pattern, team);
}

}  // namespace palpate::benchmarks
