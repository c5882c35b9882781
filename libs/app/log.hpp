// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <vector>

#include "libs/app/node_options.hpp"
#include "libs/core/severity.hpp"

namespace palpate::app {

/// Sets up logging to the standard error output, with time, level and program, and writes the one
/// line of the start: version, settings file and its hash, domain. Call once, in main().
void StartLog(const std::string& program, const NodeOptions& options);

/// The words for the lowest severity that is logged, from the lowest on.
const std::vector<std::string>& LogLevels();

/// Changes it while the process runs; false: no such level. Safe from any thread.
[[nodiscard]] bool SetLogLevel(const std::string& level);

/// One line of the log. For nodes and main() only: algorithms return diagnostics. Safe to call
/// from any thread; before StartLog() only warnings and errors are written.
void Log(Severity severity, std::string_view text);

template <typename... Values>
void LogDebug(fmt::format_string<Values...> format, Values&&... values) {
  Log(Severity::kDebug, fmt::format(format, std::forward<Values>(values)...));
}
template <typename... Values>
void LogInfo(fmt::format_string<Values...> format, Values&&... values) {
  Log(Severity::kInfo, fmt::format(format, std::forward<Values>(values)...));
}
template <typename... Values>
void LogWarning(fmt::format_string<Values...> format, Values&&... values) {
  Log(Severity::kWarning, fmt::format(format, std::forward<Values>(values)...));
}
template <typename... Values>
void LogError(fmt::format_string<Values...> format, Values&&... values) {
  Log(Severity::kError, fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace palpate::app
