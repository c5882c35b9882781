// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/progress_line.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace palpate::command {

namespace {

constexpr std::int64_t kSilent_ns = 1'000'000'000;
constexpr std::int64_t kTerminalStep_ns = 100'000'000;
constexpr std::int64_t kPlainStep_ns = 10'000'000'000;

}  // namespace

ProgressLine::ProgressLine(std::string unit, int total, Clock clock)
    : unit_(std::move(unit)),
      total_(total),
      clock_(std::move(clock)),
      start_ns_(clock_()),
      shown_ns_(start_ns_),
      terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { Clear(); }

void ProgressLine::Update(int done, double part, const std::function<std::string()>& detail) {
  const std::int64_t now_ns = clock_();
  const double elapsed_s = static_cast<double>(now_ns - start_ns_) * 1e-9;
  if (!advice_.empty()) Advise(done + part, elapsed_s);
  const std::int64_t step_ns = terminal_ ? kTerminalStep_ns : kPlainStep_ns;
  if (now_ns - start_ns_ < kSilent_ns || now_ns - shown_ns_ < step_ns) {
    return;
  }
  shown_ns_ = now_ns;
  std::string text = Text(unit_, done, total_, elapsed_s, part);
  if (detail) text += "; " + detail();
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
  std::fflush(stderr);
  on_screen_ = terminal_;
}

void ProgressLine::Advise(double reached, double elapsed_s) {
  constexpr double kLong_s = 30.0;
  constexpr double kTold_s = 5.0;  // the first of the work is no measure of the rest
  if (elapsed_s < kTold_s || !(reached > 0.0)) return;
  if ((total_ - reached) * elapsed_s / reached < kLong_s) return;
  Clear();
  std::fprintf(stderr, "%s\n", advice_.c_str());
  advice_.clear();
}

std::string ProgressLine::Text(const std::string& unit, int done, int total, double elapsed_s,
                               double part) {
  std::string text = fmt::format("{} of {} {}", done, total, unit);
  const double reached = done + part;
  if (reached > 0.0 && elapsed_s > 0.0) {
    const double rate = reached / elapsed_s;
    text += fmt::format(", {:.3g} {}/s, {:.0f} s to go", rate, unit, (total - reached) / rate);
  }
  return text;
}

void ProgressLine::Clear() {
  if (on_screen_) {
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    on_screen_ = false;
  }
}

}  // namespace palpate::command
