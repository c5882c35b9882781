// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <benchmark/benchmark.h>

#include <iostream>
#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "tests/benchmarks/machine.hpp"
#include "tests/benchmarks/suite.hpp"
#include "tests/benchmarks/table_reporter.hpp"

namespace {

/// Google Benchmark's options, ours first, so that those of the command line win. Interleaved, so
/// that a busy moment of the machine hits all benchmarks alike.
std::vector<char*> Arguments(int argc, char** argv) {
  static std::string repetitions = "--benchmark_repetitions=41";
  static std::string aggregates = "--benchmark_report_aggregates_only=true";
  static std::string interleaved = "--benchmark_enable_random_interleaving=true";
  std::vector<char*> arguments{argv[0], repetitions.data(), aggregates.data(), interleaved.data()};
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  arguments.push_back(nullptr);
  return arguments;
}

int RunBenchmarks(int argc, char** argv) {
  std::vector<char*> arguments = Arguments(argc, argv);
  int count = static_cast<int>(arguments.size()) - 1;
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  for (const auto& [name, value] : palpate::benchmarks::DescribeMachine()) {
    std::cout << name << ": " << value << '\n';
    benchmark::AddCustomContext(name, value);
  }
  std::cout << std::flush;
  palpate::benchmarks::TableReporter table(palpate::benchmarks::RegisterAll());
  benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
  return table.failed() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return RunBenchmarks(argc, argv);
  } catch (const palpate::InputError& error) {
    std::cerr << "palpate-bench: error: " << error.what() << '\n';
    return 2;
  }
}
