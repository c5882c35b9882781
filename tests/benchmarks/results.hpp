// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

/// What was measured of one benchmark.
struct Result {
  double median_ms = 0.0;        ///< wall clock
  double smallest_ms = 0.0;      ///< wall clock
  double smallest_cpu_ms = 0.0;  ///< CPU time of the calling thread
  int threads = 1;
  int repetitions = 0;
  std::map<std::string, double> counters;
  std::string error;  ///< empty: none

  bool ok() const { return error.empty() && repetitions > 0; }
  /// 0 where there is none.
  double Counter(const std::string& name) const;
  /// The time that results are compared by, the fastest run's, which other programs lengthen least:
  /// CPU time, or with more threads than one the wall clock, because a thread that waits for
  /// another may sleep.
  double ComparedMs() const { return threads > 1 ? smallest_ms : smallest_cpu_ms; }
  /// Even the fastest run waited for a core that another program had.
  bool WasHeldUp() const;
  /// 0 where nothing is known of the operations.
  double GflopPerSecond() const;
};

/// Collects what Google Benchmark reports, block after block.
class Results final : public benchmark::BenchmarkReporter {
 public:
  /// Benchmarks whose reports follow.
  void Expect(const Block& block);

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& report) override;

  /// Null where it has not run or has failed.
  const Result* Find(const std::string& name) const;
  const std::map<std::string, Result>& all() const { return results_; }
  bool empty() const { return runs_.empty(); }
  bool failed() const { return failed_; }

  /// Of the dgemm; 0 where it has not run.
  double PeakGflopPerSecond() const;
  /// Percent of the peak of as many cores as the benchmark has threads; 0 where one is not known.
  double PercentOfPeak(const Result& result) const;
  /// Time over that of the first benchmark of its block; 0 where one is not known.
  double Ratio(const std::string& name) const;

  /// All reports, those of minima with counters for the derived figures.
  std::vector<Run> RunsWithFigures() const;

 private:
  std::map<std::string, Result> results_;
  std::map<std::string, std::string> reference_;  ///< first benchmark of the block, by name
  std::vector<Run> runs_;
  std::string peak_;  ///< name of the dgemm
  bool failed_ = false;
};

}  // namespace palpate::benchmarks
