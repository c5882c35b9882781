// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>

namespace palpate::command {

/// Columns and rows of the terminal of the standard output; 120 and 50 where it tells none.
struct TerminalSize {
  std::size_t columns = 120;
  std::size_t rows = 50;
};
TerminalSize SizeOfTerminal();

/// Whether the standard output is a terminal.
bool IsTerminal();

}  // namespace palpate::command
