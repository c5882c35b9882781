// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/blind_set.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <future>
#include <mutex>
#include <random>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "tests/system/blind/score_table.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;

constexpr double kLargestSeed = 2e9;
constexpr int kAtATime = 2;

/// False: the variable is not set.
bool NumberFrom(const char* variable, double smallest, double largest, double* number) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return false;
  if (!ParseFinite(text, number) || *number != std::floor(*number) || *number < smallest ||
      *number > largest) {
    throw InputError(fmt::format("{} is '{}', not a whole number from {} to {}", variable, text,
                                 smallest, largest));
  }
  return true;
}

Measured ParseMeasured(const std::string& data) {
  if (data == "markers") return Measured::kMarkers;
  if (data == "pictures") return Measured::kPictures;
  throw InputError(
      fmt::format("PALPATE_BLIND_DATA is '{}', neither 'markers' nor 'pictures'", data));
}

/// A new one in the temporary folder of the machine, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(fs::temp_directory_path() / ("palpate_blind_" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

BlindSet BlindSet::FromEnvironment(int cases) {
  BlindSet set{.cases = cases, .seed = std::random_device()() % 1000000000u};
  double number = 0.0;
  if (NumberFrom("PALPATE_BLIND_CASES", 1.0, 1e5, &number)) set.cases = static_cast<int>(number);
  if (NumberFrom("PALPATE_BLIND_SEED", 0.0, kLargestSeed, &number)) {
    set.seed = static_cast<std::uint64_t>(number);
  }
  if (const char* folder = std::getenv("PALPATE_BLIND_FOLDER")) set.folder = folder;
  if (const char* data = std::getenv("PALPATE_BLIND_DATA")) set.measured = ParseMeasured(data);
  return set;
}

std::vector<CaseRecord> RunBlind(const BlindSet& set, std::ostream& out) {
  fmt::print(out,
             "{} blind cases of {} from seed {} on, {} moments each; one again: "
             "PALPATE_BLIND_SEED=<its seed> PALPATE_BLIND_CASES=1\n",
             set.cases, set.measured == Measured::kPictures ? "pictures" : "markers", set.seed,
             set.samples);
  const TemporaryFolder temporary;
  const bool keep = !set.folder.empty();
  if (keep) fs::create_directories(set.folder);
  const CaseRunner runner(
      {.robot_file = fs::path(PALPATE_SOURCE_DIR) / "config/robots/four_leg.yaml",
       .folder = keep ? fs::absolute(set.folder) : temporary.path(),
       .keep = keep,
       .measured = set.measured,
       .samples = set.samples});
  std::vector<CaseRecord> records(static_cast<std::size_t>(set.cases));
  std::atomic<std::size_t> next = 0;
  std::mutex printing;
  const auto work = [&] {
    for (std::size_t i = next++; i < records.size(); i = next++) {
      records[i] = runner.Run(set.seed + i);
      const std::lock_guard lock(printing);
      PrintCase(out, records[i]);
    }
  };
  std::vector<std::future<void>> workers;
  for (int i = 0; i < kAtATime; ++i) workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) worker.get();
  PrintScore(out, Judge(records));
  return records;
}

}  // namespace palpate::blind
