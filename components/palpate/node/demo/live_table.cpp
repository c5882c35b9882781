// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/live_table.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <utility>

#include "components/palpate/compare/live_line.hpp"
#include "components/palpate/node/live/terminal.hpp"

namespace palpate::command {

namespace {

constexpr std::int64_t kTerminalStep_ns = 100'000'000;
constexpr std::int64_t kPlainStep_ns = 1'000'000'000;

}  // namespace

LiveTable::LiveTable(Clock clock)
    : clock_(std::move(clock)), terminal_(IsTerminal()), shown_ns_(clock_() - kPlainStep_ns) {}

LiveTable::~LiveTable() {
  if (on_screen_) fmt::print("\n");
}

void LiveTable::Show(const std::string& line) {
  const std::int64_t now_ns = clock_();
  if (now_ns - shown_ns_ < (terminal_ ? kTerminalStep_ns : kPlainStep_ns)) return;
  shown_ns_ = now_ns;
  if (terminal_) {
    fmt::print("\r\033[K{}", Cut(line, SizeOfTerminal().columns - 1));
  } else {
    fmt::print("{}\n", line);
  }
  std::fflush(stdout);
  on_screen_ = terminal_;
}

}  // namespace palpate::command
