// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/end_on_signal.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "libs/app/run_main.hpp"

namespace palpate::command {

namespace {

void End(const std::string& line) {
  const char* clear = isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";  // of a progress line
  std::fprintf(stderr, "%s%s\n", clear, line.c_str());
  std::_Exit(app::kExitInterrupted);
}

}  // namespace

EndOnSignal::EndOnSignal(const std::string& program, const std::string& what_is_left)
    : stop_([line = program + ": interrupted: " + what_is_left] { End(line); }) {}

}  // namespace palpate::command
