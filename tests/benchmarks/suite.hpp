// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::benchmarks {

/// A line of the table.
struct Row {
  std::string name;       ///< of the benchmark
  std::string reference;  ///< the benchmark whose median its own is divided by
};

/// Registers every benchmark with Google Benchmark. What a benchmark needs is built when it first
/// runs, so that a filter saves that time, too. Throws InputError for a robot file that is wrong.
std::vector<Row> RegisterAll();

}  // namespace palpate::benchmarks
