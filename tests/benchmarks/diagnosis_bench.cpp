// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/diagnosis_bench.hpp"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

#include "libs/core/statistics.hpp"
#include "tests/benchmarks/diagnosed_robot.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/system/blind/blind_set.hpp"
#include "tests/system/blind/plan_set.hpp"
#include "tests/system/blind/score.hpp"

namespace palpate::benchmarks {

namespace {

void Count(benchmark::State& state, const std::string& name, const blind::Share& share) {
  state.counters[name] = share.hits;
  state.counters[name + "_of"] = share.count;
}

/// What is not known is left out.
void Number(benchmark::State& state, const char* name, double value) {
  if (std::isfinite(value)) state.counters[name] = value;
}

void CountAll(benchmark::State& state, const blind::Score& score) {
  Count(state, "named_first", score.top1);
  Count(state, "among_three", score.top3);
  Count(state, "false_accusations", score.false_accusations);
  Count(state, "both_named", score.both);
  Count(state, "one_of_two_named", score.one);
  Count(state, "third_named", score.third);
  Count(state, "flagged", score.flagged);
  Count(state, "false_flags", score.false_flags);
  Count(state, "unfit", score.unfit);
  Count(state, "wrongly_unfit", score.wrongly_unfit);
  Count(state, "covered", score.covered);
  Count(state, "without_verdict", score.without_verdict);
  state.counters["not_made"] = score.not_made;
  Number(state, "parameter_error_median", Median(score.parameter_errors));
  Number(state, "heldout_gain_median", Median(score.heldout_gains));
  state.counters["calibration_error"] = blind::CalibrationError(score.forecasts);
}

using Robot = std::shared_ptr<Lazy<DiagnosedRobot>>;

Benchmark Timed(const Robot& robot, const std::string& name,
                const std::function<void(DiagnosedRobot&)>& work) {
  return {.name = "diagnosis/" + name,
          .measure =
              [robot, work](benchmark::State& state) {
                DiagnosedRobot& one = robot->Get();
                for ([[maybe_unused]] auto iteration : state) work(one);
                state.counters["moments"] = one.ComparedSamples();
                state.counters["parameters"] = one.Parameters();
              },
          .threads = DiagnosedRobot::kThreads,
          .max_repetitions = 3};
}

Block StepBlock() {
  const Robot robot = MakeLazy<DiagnosedRobot>([] { return std::make_unique<DiagnosedRobot>(); });
  return {
      .heading = "diagnosis of four_leg in tet10 from config/scenarios/diagnose.yaml",
      .benchmarks = {Timed(robot, "simulate", [](auto& one) { one.Simulate(); }),
                     Timed(robot, "differentiate_one", [](auto& one) { one.DifferentiateOne(); }),
                     Timed(robot, "differentiate_all", [](auto& one) { one.DifferentiateAll(); }),
                     Timed(robot, "screen", [](auto& one) { one.ScreenAll(); })}};
}

/// A whole set that is run once: `work` gives its score, which `count` makes counters of.
template <typename Work, typename CountScore>
Block SetBlock(const std::string& heading, const std::string& name, const Work& work,
               const CountScore& count) {
  return {.heading = heading,
          .benchmarks = {{.name = "diagnosis/" + name,
                          .measure =
                              [work, count](benchmark::State& state) {
                                for ([[maybe_unused]] auto iteration : state) count(state, work());
                              },
                          .max_repetitions = 1}}};
}

Block BlindBlock() {
  const blind::BlindSet set = blind::BlindSet::FromEnvironment(1);
  return SetBlock(
      "diagnosis of hidden causes: whole sets", "blind",
      [set] { return blind::Judge(blind::RunBlind(set, std::cout)); }, CountAll);
}

Block PlanBlock() {
  const blind::BlindSet set = blind::BlindSet::FromEnvironment(1);
  return SetBlock(
      "the next experiment that a diagnosis proposes, against one drawn", "next_experiment",
      [set] { return blind::Judge(blind::RunPlans(set, std::cout)); },
      [](benchmark::State& state, const blind::PlanScore& score) {
        Count(state, "separated_by_proposed", score.proposed);
        Count(state, "separated_by_drawn", score.drawn);
      });
}

}  // namespace

std::vector<Block> DiagnosisBlocks() {
  std::vector<Block> blocks = {StepBlock()};
  if (std::getenv("PALPATE_BLIND_CASES") != nullptr) {
    blocks.push_back(BlindBlock());
    blocks.push_back(PlanBlock());
  }
  return blocks;
}

}  // namespace palpate::benchmarks
