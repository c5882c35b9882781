// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/live/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

namespace palpate::command {

TerminalSize SizeOfTerminal() {
  TerminalSize size;
  winsize told{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &told) != 0) return size;
  if (told.ws_col > 0) size.columns = told.ws_col;
  if (told.ws_row > 0) size.rows = told.ws_row;
  return size;
}

bool IsTerminal() { return isatty(STDOUT_FILENO) != 0; }

}  // namespace palpate::command
