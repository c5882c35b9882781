// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/end_on_signal.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <system_error>
#include <thread>

#include "libs/app/run_main.hpp"

namespace palpate::command {

namespace {

std::mutex g_folder_mutex;
std::filesystem::path g_folder;
std::atomic<bool> g_work_waits = false;  // in RemoveOnSignal

/// The work goes on beside this and may make the folder again. So the folder is removed until the
/// work has failed for want of it and waits, or for as long as a single write may take.
void RemoveFolder() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(2);
  std::error_code ignored;
  bool work_waits = false;
  do {
    work_waits = g_work_waits;
    std::filesystem::remove_all(g_folder, ignored);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (!work_waits && Clock::now() < deadline);
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
  g_work_waits = true;
  const std::lock_guard lock(g_folder_mutex);
  g_work_waits = false;
  g_folder = folder;
}

EndOnSignal::EndOnSignal(const std::string& program, const std::string& what_is_left)
    : stop_([line = program + ": interrupted: " + what_is_left] { End(line); }) {}

}  // namespace palpate::command
