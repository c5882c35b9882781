// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/end_on_signal.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <system_error>

#include "libs/app/run_main.hpp"

namespace palpate::command {

namespace {

std::mutex g_folder_mutex;
std::filesystem::path g_folder;

/// Others may still write into it, and remove_all then finds it filled again.
void RemoveFolder() {
  std::error_code ignored;
  constexpr int kAttempts = 100;
  for (int i = 0; i < kAttempts && std::filesystem::exists(g_folder, ignored); ++i) {
    std::filesystem::remove_all(g_folder, ignored);
  }
}

void End(const std::string& line) {
  // Kept to the end: work that fails for want of the folder shall not end the process in our place.
  const std::lock_guard lock(g_folder_mutex);
  const char* clear = isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";  // of a progress line
  std::fprintf(stderr, "%s%s\n", clear, line.c_str());
  if (!g_folder.empty()) RemoveFolder();
  std::_Exit(app::kExitInterrupted);
}

}  // namespace

void RemoveOnSignal(const std::filesystem::path& folder) {
  const std::lock_guard lock(g_folder_mutex);
  g_folder = folder;
}

EndOnSignal::EndOnSignal(const std::string& program, const std::string& what_is_left)
    : stop_([line = program + ": interrupted: " + what_is_left] { End(line); }) {}

}  // namespace palpate::command
