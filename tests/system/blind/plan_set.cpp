// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/plan_set.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>

#include <iterator>
#include <mutex>

#include "tests/support/robots.hpp"
#include "tests/system/blind/blind_case.hpp"
#include "tests/system/blind/set_folder.hpp"
#include "tests/system/blind/two_at_a_time.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;

/// For each question that is wanted: not every case leaves one.
constexpr int kMostTries = 10;

std::string Came(const PlanOutcome& outcome) {
  return fmt::format("{} ({}): {}", outcome.title, outcome.rank,
                     outcome.separated ? "separated" : "not separated");
}

void Print(std::ostream& out, const PlanRecord& record) {
  const std::string hidden = Describe(record.effect);
  if (!record.no_question.empty()) {
    fmt::print(out, "{} {} | no question: {}\n", record.seed, hidden, record.no_question);
  } else {
    fmt::print(out, "{} {} | of {}, proposed {} | drawn {}\n", record.seed, hidden, record.ranked,
               Came(record.proposed), Came(record.drawn));
  }
  out.flush();
}

void Print(std::ostream& out, const char* what, const Share& share) {
  fmt::print(out, "{:<28}{:>4} of {:<4}{:>6.0f} %\n", what, share.hits, share.count,
             100.0 * share.value());
}

}  // namespace

PlanScore Judge(const std::vector<PlanRecord>& records) {
  PlanScore score;
  for (const PlanRecord& record : records) {
    if (!record.no_question.empty()) continue;
    score.proposed.Add(record.proposed.separated);
    score.drawn.Add(record.drawn.separated);
  }
  return score;
}

std::vector<PlanRecord> RunPlans(const BlindSet& set, std::ostream& out) {
  fmt::print(out,
             "{} questions from seed {} on; one again: PALPATE_BLIND_SEED=<its seed> "
             "PALPATE_BLIND_CASES=1\n",
             set.cases, set.seed);
  const SetFolder folder(set.folder);
  const PlanRunner runner(
      {.robot_file = test_support::RobotFile("four_leg"), .folder = folder.path()});
  std::vector<PlanRecord> records;
  std::mutex mutex;
  TwoAtATime([&](std::size_t k) {
    PlanRecord record = runner.Run(set.seed + k);
    const std::lock_guard lock(mutex);
    Print(out, record);
    records.push_back(std::move(record));
    return Judge(records).proposed.count < set.cases &&
           std::ssize(records) < kMostTries * set.cases;
  });
  const PlanScore score = Judge(records);
  Print(out, "the experiment proposed", score.proposed);
  Print(out, "one drawn of its ranking", score.drawn);
  return records;
}

}  // namespace palpate::blind
