// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/results.hpp"

#include <algorithm>

namespace palpate::benchmarks {

namespace {

/// Wall-clock over CPU time of a run that other programs have held up.
constexpr double kHeldUp = 1.3;

/// A single repetition has no median and no minimum but itself.
bool IsSingle(const benchmark::BenchmarkReporter::Run& run) {
  return run.run_type == benchmark::BenchmarkReporter::Run::RT_Iteration && run.repetitions <= 1;
}

bool IsMedian(const benchmark::BenchmarkReporter::Run& run) {
  return IsSingle(run) || run.aggregate_name == "median";
}

bool IsMinimum(const benchmark::BenchmarkReporter::Run& run) {
  return IsSingle(run) || run.aggregate_name == "min";
}

}  // namespace

double Result::Counter(const std::string& name) const {
  const auto found = counters.find(name);
  return found == counters.end() ? 0.0 : found->second;
}

bool Result::WasHeldUp() const { return smallest_ms > kHeldUp * smallest_cpu_ms; }

double Result::GflopPerSecond() const {
  return ComparedMs() > 0.0 ? 1e-6 * Counter(kFlops) / ComparedMs() : 0.0;
}

void Results::Expect(const Block& block) {
  for (const Benchmark& benchmark : block.benchmarks) {
    results_[benchmark.name].threads = benchmark.threads;
    if (block.benchmarks.size() > 1) reference_[benchmark.name] = block.benchmarks.front().name;
    if (benchmark.name.rfind("dgemm", 0) == 0) peak_ = benchmark.name;
  }
}

bool Results::ReportContext(const Context& /*context*/) { return true; }

void Results::ReportRuns(const std::vector<Run>& report) {
  for (const Run& run : report) {
    Result& result = results_[run.run_name.function_name];
    runs_.push_back(run);
    runs_.back().statistics = nullptr;  // they go with the benchmark
    if (run.error_occurred) {
      result.error = run.error_message;
      failed_ = true;
      continue;
    }
    if (IsMedian(run)) {
      result.median_ms = run.GetAdjustedRealTime();
      result.repetitions = static_cast<int>(run.repetitions);
      for (const auto& [name, counter] : run.counters) result.counters[name] = counter.value;
    }
    if (IsMinimum(run)) {
      result.smallest_ms = run.GetAdjustedRealTime();
      result.smallest_cpu_ms = run.GetAdjustedCPUTime();
    }
  }
}

const Result* Results::Find(const std::string& name) const {
  const auto found = results_.find(name);
  return found != results_.end() && found->second.ok() ? &found->second : nullptr;
}

double Results::PeakGflopPerSecond() const {
  const Result* peak = Find(peak_);
  return peak == nullptr ? 0.0 : peak->GflopPerSecond();
}

double Results::PercentOfPeak(const Result& result) const {
  const double peak = PeakGflopPerSecond();
  return peak > 0.0 ? 100.0 * result.GflopPerSecond() / (peak * result.threads) : 0.0;
}

double Results::Ratio(const std::string& name) const {
  const Result* result = Find(name);
  const auto reference_name = reference_.find(name);
  if (result == nullptr || reference_name == reference_.end()) return 0.0;
  const Result* reference = Find(reference_name->second);
  return reference == nullptr ? 0.0 : result->ComparedMs() / reference->ComparedMs();
}

std::vector<Results::Run> Results::RunsWithFigures() const {
  std::vector<Run> runs = runs_;
  for (Run& run : runs) {
    const std::string& name = run.run_name.function_name;
    const Result* result = Find(name);
    if (result == nullptr || !IsMinimum(run)) continue;
    const auto add = [&](const char* figure, double value) {
      if (value > 0.0) run.counters[figure] = value;
    };
    add("ratio", Ratio(name));
    add("GFLOP_per_s", result->GflopPerSecond());
    add("percent_of_dgemm_peak", PercentOfPeak(*result));
  }
  return runs;
}

}  // namespace palpate::benchmarks
