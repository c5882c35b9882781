// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

#include "tests/benchmarks/suite.hpp"

namespace palpate::benchmarks {

/// Collects the repetitions' statistics and prints one table after the last run.
class TableReporter final : public benchmark::BenchmarkReporter {
 public:
  explicit TableReporter(std::vector<Row> rows) : rows_(std::move(rows)) {}

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& report) override;
  void Finalize() override;

  bool failed() const { return failed_; }

 private:
  struct Result {
    double median_ms = 0.0;
    double smallest_ms = 0.0;
    double cpu_ms = 0.0;
    double memory_MiB = 0.0;
    double qp_steps = 0.0;
    int runs = 0;
    std::string error;
  };

  void PrintRow(const Row& row, const Result& result);

  std::vector<Row> rows_;
  std::map<std::string, Result> results_;
  bool failed_ = false;
};

}  // namespace palpate::benchmarks
