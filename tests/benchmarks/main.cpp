// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <benchmark/benchmark.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/benchmarks/machine.hpp"
#include "tests/benchmarks/memory.hpp"
#include "tests/benchmarks/options.hpp"
#include "tests/benchmarks/results.hpp"
#include "tests/benchmarks/scaling_law.hpp"
#include "tests/benchmarks/sensing_table.hpp"
#include "tests/benchmarks/suite.hpp"
#include "tests/benchmarks/table.hpp"

namespace palpate::benchmarks {

namespace {

/// False where Google Benchmark does not know an option; it has said so.
bool InitializeGoogleBenchmark(const Options& options) {
  static std::vector<std::string> arguments;  // it keeps pointers to them
  arguments = options.passed_on;
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  pointers.push_back(nullptr);
  benchmark::Initialize(&count, pointers.data());
  return !benchmark::ReportUnrecognizedArguments(count, pointers.data());
}

double Smallest(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

void Register(const Block& block, int repetitions) {
  for (const Benchmark& benchmark : block.benchmarks) {
    const auto guarded = [measure = benchmark.measure](benchmark::State& state) {
      try {
        measure(state);
      } catch (const std::exception& error) {
        state.SkipWithError(error.what());
      }
    };
    benchmark::RegisterBenchmark(benchmark.name.c_str(), guarded)
        ->Iterations(1)
        ->Repetitions(std::min(repetitions, benchmark.max_repetitions))
        ->ComputeStatistics("min", Smallest)
        ->Unit(benchmark::kMillisecond);
  }
}

/// Runs, or lists, what the filter leaves of the suite. Gives the number of those benchmarks.
size_t RunBlocks(std::vector<Block> blocks, const Options& options, Results* results) {
  Table table(std::cout, *results);
  size_t count = 0;
  for (Block& block : blocks) {
    Register(block, options.repetitions);
    results->Expect(block);
    count += benchmark::RunSpecifiedBenchmarks(results);
    benchmark::ClearRegisteredBenchmarks();
    table.Print(block);
    block = {};  // and what only its benchmarks held
  }
  return count;
}

void WriteJson(const std::filesystem::path& file, const Results& results,
               const std::vector<ScalingLaw>& laws) {
  std::ostringstream text;
  benchmark::JSONReporter json;
  json.SetOutputStream(&text);
  json.ReportContext({});
  json.ReportRuns(results.RunsWithFigures());
  json.ReportRuns(ToRuns(laws));
  json.Finalize();
  WriteFile(file, text.str());
}

int Run(const Options& options) {
  if (!InitializeGoogleBenchmark(options)) return 2;
  if (!options.json.empty()) WriteFile(options.json, "");  // fails now rather than in the end
  for (const auto& [name, value] : DescribeMachine()) {
    std::cout << name << ": " << value << '\n';
    benchmark::AddCustomContext(name, value);
  }
  Suite suite = MakeSuite();
  Results results;
  std::ostringstream complaints;  // that nothing of a block matches the filter, and the like
  results.SetErrorStream(&complaints);
  if (RunBlocks(std::move(suite.blocks), options, &results) == 0) {
    const std::string all = complaints.str();
    std::cerr << "palpate-bench: error: " << all.substr(0, all.find('\n')) << '\n';
    return 2;
  }
  const std::vector<ScalingLaw> laws = FitScalingLaws(results, suite.family);
  Print(std::cout, laws, suite.family);
  PrintSensing(std::cout, results);
  if (!results.empty()) {
    std::cout << "\nPeak resident memory of the whole run: "
              << FixedOrDash(PeakResidentBytes() / 1048576.0, 0) << " MiB\n";
  }
  if (!options.json.empty()) WriteJson(options.json, results, laws);
  benchmark::Shutdown();
  return results.failed() ? 1 : 0;
}

}  // namespace

}  // namespace palpate::benchmarks

int main(int argc, char** argv) {
  try {
    return palpate::benchmarks::Run(palpate::benchmarks::ParseOptions(argc, argv));
  } catch (const palpate::InputError& error) {
    std::cerr << "palpate-bench: error: " << error.what() << '\n';
    return 2;
  } catch (const palpate::RunError& error) {
    std::cerr << "palpate-bench: error: " << error.what() << '\n';
    return 1;
  }
}
