// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::benchmarks {

/// The command line. All options are Google Benchmark's; what follows is not passed on to it, since
/// it is called once for each block.
struct Options {
  std::filesystem::path json;  ///< --benchmark_out, or empty
  int repetitions = 41;        ///< --benchmark_repetitions
  /// The program's name and the options for Google Benchmark.
  std::vector<std::string> passed_on;
};

/// Throws InputError for an output format other than JSON, and for a number that is none.
Options ParseOptions(int argc, const char* const* argv);

}  // namespace palpate::benchmarks
