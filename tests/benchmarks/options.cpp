// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/options.hpp"

#include <cmath>
#include <optional>
#include <string_view>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::benchmarks {

namespace {

std::optional<std::string> ValueOf(std::string_view argument, std::string_view option) {
  if (argument.substr(0, option.size()) != option) return std::nullopt;
  return std::string(argument.substr(option.size()));
}

int ParseRepetitions(const std::string& text) {
  double value = 0.0;
  if (!ParseFinite(text, &value) || value < 1.0 || value > 1e6 || value != std::floor(value)) {
    throw InputError("--benchmark_repetitions=" + text + ": must be a whole number from 1 on");
  }
  return static_cast<int>(value);
}

}  // namespace

Options ParseOptions(int argc, const char* const* argv) {
  Options options;
  // Ours first, so that those of the command line win.
  options.passed_on = {argv[0], "--benchmark_report_aggregates_only=true",
                       "--benchmark_enable_random_interleaving=true"};
  for (int k = 1; k < argc; ++k) {
    if (const auto file = ValueOf(argv[k], "--benchmark_out=")) {
      options.json = *file;
    } else if (const auto format = ValueOf(argv[k], "--benchmark_out_format=")) {
      if (*format != "json") {
        throw InputError("--benchmark_out_format=" + *format + ": json alone is written");
      }
    } else if (const auto repetitions = ValueOf(argv[k], "--benchmark_repetitions=")) {
      options.repetitions = ParseRepetitions(*repetitions);
    } else {
      options.passed_on.emplace_back(argv[k]);
    }
  }
  return options;
}

}  // namespace palpate::benchmarks
