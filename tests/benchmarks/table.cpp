// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/table.hpp"

#include <iomanip>
#include <sstream>

namespace palpate::benchmarks {

namespace {

constexpr int kNameWidth = 57;
constexpr int kWidth = kNameWidth + 73;

}  // namespace

std::string FixedOrDash(double value, int digits) {
  if (value == 0.0) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

void Table::Print(const Block& block) {
  bool is_first = true;
  for (const Benchmark& benchmark : block.benchmarks) {
    const auto found = results_.all().find(benchmark.name);
    if (found == results_.all().end()) continue;
    const Result& result = found->second;
    if (!result.ok() && result.error.empty()) continue;
    if (!has_head_) PrintHead();
    if (is_first) out_ << '\n';
    if (heading_ != block.heading) out_ << block.heading << '\n';
    heading_ = block.heading;
    is_first = false;
    PrintLine(benchmark.name, result);
  }
  out_ << std::flush;
}

void Table::PrintHead() {
  has_head_ = true;
  out_ << R"(
One call a repetition. Median and minimum of wall-clock time, minimum of the calling thread's CPU time.
Ratio: to the first line of the same block, of the fastest runs, by CPU time with one thread and by the
wall clock with two. Memory: what the sparse solver holds. GFLOP/s: each solver's own count of
operations over that same time (multifrontal counts zeros that it stores, too); peak: that of dgemm in
this run, twice that for two threads. No core free: other programs held up even the fastest run, and a
row with two threads says little.

)" << std::left
       << std::setw(kNameWidth) << "benchmark" << std::right << std::setw(5) << "runs"
       << std::setw(12) << "median ms" << std::setw(11) << "min ms" << std::setw(11) << "CPU min"
       << std::setw(9) << "ratio" << std::setw(8) << "MiB" << std::setw(9) << "GFLOP/s"
       << std::setw(8) << "% peak" << '\n'
       << std::string(kWidth, '-') << '\n';
}

void Table::PrintLine(const std::string& name, const Result& result) {
  out_ << std::left << std::setw(kNameWidth) << name << std::right;
  if (!result.error.empty()) {
    out_ << "  failed: " << result.error << '\n';
    return;
  }
  out_ << std::setw(5) << result.repetitions << std::setw(12) << FixedOrDash(result.median_ms, 3)
       << std::setw(11) << FixedOrDash(result.smallest_ms, 3) << std::setw(11)
       << FixedOrDash(result.smallest_cpu_ms, 3) << std::setw(9)
       << FixedOrDash(results_.Ratio(name), 2) << std::setw(8)
       << FixedOrDash(result.Counter(kMemory), 1) << std::setw(9)
       << FixedOrDash(result.GflopPerSecond(), 1) << std::setw(8)
       << FixedOrDash(results_.PercentOfPeak(result), 0);
  const double qp_steps = result.Counter("qp_steps");
  if (qp_steps > 1.0) out_ << "  (" << FixedOrDash(qp_steps, 0) << " QPs a frame)";
  if (result.WasHeldUp()) out_ << "  (no core free)";
  out_ << '\n';
}

}  // namespace palpate::benchmarks
