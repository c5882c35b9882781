// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <benchmark/benchmark.h>

#include "tests/benchmarks/workbench.hpp"

namespace palpate::benchmarks {

/// Calls that are not timed.
struct WarmUp {
  int first = 0;  ///< before the first that is timed
  int each = 1;   ///< before each
  int Calls(bool is_first) const { return each + (is_first ? first : 0); }
};

/// Each times one call and adds what it knows as counters (block.hpp).
void MeasureUpdate(benchmark::State& state, SensingScene& scene, WarmUp warm_up);
void MeasureAssembly(benchmark::State& state, Assembly& assembly, WarmUp warm_up);
void MeasureFactorization(benchmark::State& state, SolverBench& bench, WarmUp warm_up);
void MeasureSolution(benchmark::State& state, SolverBench& bench, int columns, WarmUp warm_up);
void MeasureDgemm(benchmark::State& state, int size);

}  // namespace palpate::benchmarks
