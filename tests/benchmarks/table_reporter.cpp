// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/table_reporter.hpp"

#include <iomanip>
#include <ostream>
#include <sstream>

#include "tests/benchmarks/memory.hpp"

namespace palpate::benchmarks {

namespace {

std::string Fixed(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

double Counter(const benchmark::BenchmarkReporter::Run& run, const std::string& name) {
  const auto found = run.counters.find(name);
  return found == run.counters.end() ? 0.0 : found->second.value;
}

}  // namespace

bool TableReporter::ReportContext(const Context& /*context*/) { return true; }

void TableReporter::ReportRuns(const std::vector<Run>& report) {
  for (const Run& run : report) {
    Result& result = results_[run.run_name.function_name];
    if (run.error_occurred) {
      result.error = run.error_message;
      failed_ = true;
      continue;
    }
    // A single repetition has no median but itself.
    const bool single = run.run_type == Run::RT_Iteration && run.repetitions <= 1;
    if (single || run.aggregate_name == "median") {
      result.median_ms = run.GetAdjustedRealTime();
      result.cpu_ms = run.GetAdjustedCPUTime();
      result.memory_MiB = Counter(run, "memory_MiB");
      result.qp_steps = Counter(run, "qp_steps");
      result.runs = static_cast<int>(run.repetitions);
    }
    if (single || run.aggregate_name == "min") result.smallest_ms = run.GetAdjustedRealTime();
  }
}

void TableReporter::Finalize() {
  std::ostream& out = GetOutputStream();
  out << "\nOne call a repetition; median and minimum of wall-clock time, median of CPU time; "
         "ratios are of CPU\nmedians of this run. Memory: what the sparse solver holds.\n\n"
      << std::left << std::setw(42) << "benchmark" << std::right << std::setw(6) << "runs"
      << std::setw(12) << "median ms" << std::setw(10) << "min ms" << std::setw(10) << "CPU ms"
      << std::setw(12) << "memory MiB" << std::setw(9) << "ratio"
      << "  to\n"
      << std::string(126, '-') << '\n';
  for (const Row& row : rows_) {
    const auto found = results_.find(row.name);
    if (found != results_.end()) PrintRow(row, found->second);
  }
  out << "\nPeak resident memory of the whole run: " << Fixed(PeakResidentBytes() / 1048576.0, 1)
      << " MiB\n";
}

void TableReporter::PrintRow(const Row& row, const Result& result) {
  std::ostream& out = GetOutputStream();
  out << std::left << std::setw(42) << row.name << std::right;
  if (!result.error.empty()) {
    out << "  failed: " << result.error << '\n';
    return;
  }
  const std::string memory = result.memory_MiB > 0.0 ? Fixed(result.memory_MiB, 1) : "-";
  out << std::setw(6) << result.runs << std::setw(12) << Fixed(result.median_ms, 3) << std::setw(10)
      << Fixed(result.smallest_ms, 3) << std::setw(10) << Fixed(result.cpu_ms, 3) << std::setw(12)
      << memory;
  const auto reference = results_.find(row.reference);
  if (reference != results_.end() && reference->second.cpu_ms > 0.0) {
    out << std::setw(9) << Fixed(result.cpu_ms / reference->second.cpu_ms, 2) << "  "
        << row.reference;
  }
  if (result.qp_steps > 1.0) {
    out << " (" << Fixed(result.qp_steps, 0) << " QPs a frame)";
  }
  out << '\n';
}

}  // namespace palpate::benchmarks
