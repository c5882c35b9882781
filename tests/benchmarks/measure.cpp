// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/measure.hpp"

#include "tests/benchmarks/block.hpp"
#include "tests/benchmarks/dgemm.hpp"
#include "tests/benchmarks/memory.hpp"

namespace palpate::benchmarks {

namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

void CountSolver(benchmark::State& state, const fem::SparseSolver& solver) {
  state.counters[kMemory] = static_cast<double>(solver.MemoryBytes()) / kMebibyte;
  state.counters[kNonzeros] = static_cast<double>(solver.FactorNonzeros());
}

}  // namespace

void MeasureUpdate(benchmark::State& state, SensingScene& scene, WarmUp warm_up) {
  const bool is_first = scene.qp_steps() == 0;
  for (int k = 0; k < warm_up.Calls(is_first); ++k) scene.TakeFrame();
  for ([[maybe_unused]] auto iteration : state) scene.TakeFrame();
  CountSolver(state, scene.model().linearisation().solver());
  state.counters[kRows] = scene.model().linearisation().Size();
  state.counters["qp_steps"] = scene.qp_steps();
  state.counters["peak_rss_MiB"] = PeakResidentBytes() / kMebibyte;
}

void MeasureAssembly(benchmark::State& state, Assembly& assembly, WarmUp warm_up) {
  for (int k = 0; k < warm_up.each; ++k) assembly.Assemble();
  for ([[maybe_unused]] auto iteration : state) assembly.Assemble();
  state.counters[kRows] = assembly.Size();
}

void MeasureFactorization(benchmark::State& state, SolverBench& bench, WarmUp warm_up) {
  const bool is_first = !bench.has_factor();
  for (int k = 0; k < warm_up.Calls(is_first); ++k) bench.Factorize();
  for ([[maybe_unused]] auto iteration : state) bench.Factorize();
  CountSolver(state, bench.solver());
  state.counters[kRows] = bench.Size();
  state.counters[kFlops] = bench.solver().FactorFlops();
}

void MeasureSolution(benchmark::State& state, SolverBench& bench, int columns, WarmUp warm_up) {
  if (!bench.has_factor()) bench.Factorize();
  bench.SetColumns(columns, warm_up.each + 1);
  for (int k = 0; k < warm_up.each; ++k) bench.SolveNext();
  for ([[maybe_unused]] auto iteration : state) bench.SolveNext();
  bench.CheckLast();
  CountSolver(state, bench.solver());
  state.counters[kRows] = bench.Size();
  // Each entry of the factor multiplies and adds on the way forward and on the way back.
  state.counters[kFlops] = 4.0 * columns * static_cast<double>(bench.solver().FactorNonzeros());
}

void MeasureDgemm(benchmark::State& state, int size) {
  Dgemm dgemm(size);
  dgemm.Multiply();
  for ([[maybe_unused]] auto iteration : state) dgemm.Multiply();
  benchmark::DoNotOptimize(dgemm.FirstEntry());
  state.counters[kFlops] = dgemm.Flops();
}

}  // namespace palpate::benchmarks
