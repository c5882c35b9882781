// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/prefixed_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace palpate::command {

namespace {

constexpr std::string_view kLauncher = "launch";
constexpr double kMegabyte_bytes = 1e6;
constexpr char kPlain[] = "\033[0m";
constexpr char kRed[] = "\033[31m";
constexpr char kYellow[] = "\033[33m";
// Neither red nor yellow, which are errors and warnings.
constexpr std::array<const char*, 8> kColours{"\033[36m", "\033[32m", "\033[35m", "\033[34m",
                                              "\033[96m", "\033[92m", "\033[95m", "\033[94m"};

std::string EndText(const ProcessReport& report) {
  if (!report.last_end) return "-";
  return report.last_end->signal != 0 ? fmt::format("signal {}", report.last_end->signal)
                                      : fmt::format("{}", report.last_end->exit_code);
}

}  // namespace

PrefixedOutput::PrefixedOutput(const std::vector<std::string>& names, std::FILE* file,
                               bool with_colour)
    : file_(file), with_colour_(with_colour), width_(kLauncher.size()) {
  for (const std::string& name : names) {
    width_ = std::max(width_, name.size());
    colours_[name] = kColours[colours_.size() % kColours.size()];
  }
}

void PrefixedOutput::Line(const std::string& process, std::string_view line) {
  Write(process, colours_[process], line);
}

void PrefixedOutput::Event(const std::string& process, Severity severity, const std::string& text) {
  const std::string colour = severity >= Severity::kError     ? kRed
                             : severity >= Severity::kWarning ? kYellow
                                                              : "";
  Write(std::string(kLauncher), colour, process.empty() ? text : process + ": " + text);
}

void PrefixedOutput::Write(const std::string& name, const std::string& colour,
                           std::string_view text) {
  const std::string prefix = "[" + name + "]" + std::string(width_ - name.size(), ' ');
  if (with_colour_ && !colour.empty()) {
    fmt::print(file_, "{}{}{} {}\n", colour, prefix, kPlain, text);
  } else {
    fmt::print(file_, "{} {}\n", prefix, text);
  }
  std::fflush(file_);
}

std::string ReportText(const std::vector<ProcessReport>& reports) {
  std::size_t width = std::string_view("process").size();
  for (const ProcessReport& report : reports) width = std::max(width, report.name.size());
  std::string text = fmt::format("{:<{}}  {:<9}  {:>9}  {:>8}  {:>10}  {:>11}\n", "process", width,
                                 "state", "exit code", "restarts", "run time", "peak memory");
  for (const ProcessReport& report : reports) {
    const double memory_MB = static_cast<double>(report.peak_memory_bytes) / kMegabyte_bytes;
    text += fmt::format("{:<{}}  {:<9}  {:>9}  {:>8}  {:>8.1f} s  {:>8.1f} MB{}\n", report.name,
                        width, ToString(report.state), EndText(report), report.restarts,
                        report.run_time_s, memory_MB, report.required ? "  required" : "");
    if (report.failed) text += fmt::format("{:<{}}  {}\n", "", width, report.reason);
  }
  return text;
}

std::string ReportJson(const std::string& system, const std::string& host, int exit_code,
                       const std::vector<ProcessReport>& reports) {
  nlohmann::ordered_json processes = nlohmann::ordered_json::array();
  for (const ProcessReport& report : reports) {
    nlohmann::ordered_json one = {{"name", report.name},
                                  {"required", report.required},
                                  {"state", ToString(report.state)},
                                  {"failed", report.failed},
                                  {"reason", report.reason},
                                  {"exit_code", nullptr},
                                  {"signal", nullptr},
                                  {"restarts", report.restarts},
                                  {"run_time_s", report.run_time_s},
                                  {"peak_memory_bytes", report.peak_memory_bytes}};
    if (report.last_end && report.last_end->signal == 0) {
      one["exit_code"] = report.last_end->exit_code;
    } else if (report.last_end) {
      one["signal"] = report.last_end->signal;
    }
    processes.push_back(one);
  }
  const nlohmann::ordered_json document = {
      {"system", system}, {"host", host}, {"exit_code", exit_code}, {"processes", processes}};
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace palpate::command
