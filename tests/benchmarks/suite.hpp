// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

struct Suite {
  /// In the order in which they run. What a benchmark needs is built when it first runs, so that a
  /// filter saves that time, and goes with the last benchmark that holds it.
  std::vector<Block> blocks;
  /// First parts of the names of benchmarks whose meshes differ in nothing but their refinement.
  std::vector<std::string> family;
};

/// Throws InputError for a robot file that is wrong.
Suite MakeSuite();

}  // namespace palpate::benchmarks
