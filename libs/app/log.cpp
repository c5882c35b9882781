// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>

#include "libs/app/version.hpp"
#include "libs/core/check.hpp"

namespace palpate::app {

namespace {

std::shared_ptr<spdlog::logger> MakeLogger(const std::string& program,
                                           spdlog::level::level_enum level) {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  auto logger = std::make_shared<spdlog::logger>(program, std::move(sink));
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ [%l] %n: %v", spdlog::pattern_time_type::utc);
  logger->set_level(level);
  logger->flush_on(spdlog::level::info);
  return logger;
}

spdlog::level::level_enum SpdlogLevel(Severity severity) {
  switch (severity) {
    case Severity::kDebug: return spdlog::level::debug;
    case Severity::kInfo: return spdlog::level::info;
    case Severity::kWarning: return spdlog::level::warn;
    case Severity::kError: return spdlog::level::err;
  }
  PALPATE_CHECK(false, static_cast<int>(severity));
  return spdlog::level::err;
}

/// Replaced once, by StartLog(), before a node makes its threads.
std::shared_ptr<spdlog::logger>& Logger() {
  static std::shared_ptr<spdlog::logger> logger = MakeLogger("palpate", spdlog::level::warn);
  return logger;
}

}  // namespace

void StartLog(const std::string& program, const NodeOptions& options) {
  const auto level = spdlog::level::from_str(options.log_level);
  PALPATE_CHECK(level != spdlog::level::off, options.log_level);
  Logger() = MakeLogger(program, level);
  if (options.config_file.empty()) {
    LogInfo("version {}, no settings file, domain {}", Version(), options.domain_id);
  } else {
    LogInfo("version {}, settings {} (sha256 {}), domain {}", Version(),
            options.config_file.string(), options.config_sha256.substr(0, 12), options.domain_id);
  }
}

const std::vector<std::string>& LogLevels() {
  static const std::vector<std::string> kLevels{"debug", "info", "warning", "error"};
  return kLevels;
}

bool SetLogLevel(const std::string& level) {
  if (std::find(LogLevels().begin(), LogLevels().end(), level) == LogLevels().end()) return false;
  Logger()->set_level(spdlog::level::from_str(level));
  return true;
}

void Log(Severity severity, std::string_view text) { Logger()->log(SpdlogLevel(severity), text); }

}  // namespace palpate::app
