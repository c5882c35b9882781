// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/run_main.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

#include "libs/core/error.hpp"

namespace palpate::app {

namespace {

void PrintLine(const std::string& program, const char* kind, std::string cause) {
  for (char& c : cause) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  while (cause.ends_with(' ')) cause.pop_back();
  std::fprintf(stderr, "%s: %s%s\n", program.c_str(), kind, cause.c_str());
}

void PrintError(const std::string& program, const std::string& cause) {
  PrintLine(program, "error: ", cause);
}

/// Text is buffered: only the last flush shows whether all of it was written.
void FlushOutput() {
  errno = 0;
  std::cout.flush();
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  if (written) return;
  const std::string cause = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
  throw RunError("standard output could not be written" + cause);
}

}  // namespace

int RunMain(const std::string& program, const std::function<int()>& work) {
  try {
    const int exit_code = work();
    FlushOutput();
    return exit_code;
  } catch (const Interrupted& interrupted) {
    PrintLine(program, "interrupted ", interrupted.what());
    return kExitInterrupted;
  } catch (const InputError& error) {
    PrintError(program, error.what());
    return kExitUsage;
  } catch (const RunError& error) {
    std::fprintf(stderr, "%s: error: %s\n", program.c_str(), error.what());
  } catch (const std::bad_alloc&) {
    PrintError(program, "out of memory");
  } catch (const std::exception& error) {
    PrintError(program, error.what());
  }
  return kExitFailed;
}

}  // namespace palpate::app
