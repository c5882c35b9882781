// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

namespace palpate::benchmarks {

/// A benchmark and a line of the table.
struct Benchmark {
  std::string name;
  std::function<void(benchmark::State&)> measure;  ///< one call for each repetition
  int threads = 1;
  int max_repetitions = 1000;
};

/// Benchmarks that are compared with the first of them: their repetitions take turns, so that a
/// busy moment of the machine hits all alike.
struct Block {
  std::string heading;  ///< above the table's lines where it is another than the block's before
  std::vector<Benchmark> benchmarks;
};

/// Names of the counters that the table and the fits read.
inline constexpr const char* kRows = "rows";          ///< of the linear system
inline constexpr const char* kFlops = "flops";        ///< of one call
inline constexpr const char* kMemory = "memory_MiB";  ///< held by the sparse solver
inline constexpr const char* kNonzeros = "factor_nonzeros";

}  // namespace palpate::benchmarks
