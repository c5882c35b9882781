// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/dds_reports.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <string>

#include "libs/core/repeated_warning.hpp"

namespace palpate::dds {

namespace {

struct Reports {
  std::mutex mutex;
  RepeatedWarning repeated;
};

/// Never destroyed: threads of Cyclone DDS may report until the process ends.
Reports& AllReports() {
  static auto* reports = new Reports;
  return *reports;
}

void Print(const std::string& line) { std::fprintf(stderr, "DDS: %s\n", line.c_str()); }

void Report(void*, const dds_log_data_t* data) {
  std::string text(data->message, data->size);
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  Reports& reports = AllReports();
  const std::lock_guard lock(reports.mutex);
  for (const std::string& line : reports.repeated.TakeDue()) Print(line);
  if (const auto line = reports.repeated.Add(text, "")) Print(*line);
}

}  // namespace

void CountRepeatedDdsReports() {
  static std::once_flag once;
  std::call_once(once, [] { dds_set_log_sink(Report, nullptr); });
}

}  // namespace palpate::dds
