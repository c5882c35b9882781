// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate_verb.hpp"

#include <fmt/core.h>

#include <limits>
#include <memory>
#include <optional>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/progress_line.hpp"
#include "components/palpate/simulate/sealed_answer.hpp"
#include "components/palpate/simulate/simulation.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

std::filesystem::path AnswerFile(const SimulateOptions& options,
                                 const std::filesystem::path& experiment) {
  return options.answer.empty() ? AnswerBeside(experiment) : options.answer;
}

int Check(const SimulateOptions& options) {
  if (!options.robot.empty() || !options.scenario.empty() || !options.out.empty()) {
    throw InputError("--check goes with --answer alone: nothing is simulated");
  }
  const std::filesystem::path answer = AnswerFile(options, options.check);
  CheckSeal(options.check, answer);
  fmt::print("{} is the answer that was sealed with {}\n", answer.string(), options.check.string());
  return app::kExitDone;
}

SimulationJob JobOf(const SimulateOptions& options) {
  if (options.robot.empty()) throw InputError("which robot? palpate simulate ROBOT ...");
  if (options.scenario.empty()) throw InputError("--scenario is missing");
  if (options.out.empty()) throw InputError("--out is missing");
  SimulationJob job;
  job.robot = robot::ReadRobotFile(FindRobotFile(options.robot), app::LoadYaml);
  job.scenario = scenario::ReadScenario(options.scenario, app::LoadYaml);
  job.seed = static_cast<std::uint64_t>(options.seed);
  job.out = options.out;
  job.answer = AnswerFile(options, options.out);
  job.tell_camera_pose = options.tell_camera_pose;
  return job;
}

}  // namespace

int SimulateOrCheck(const SimulateOptions& options, const MakeBench& make_bench) {
  if (!options.check.empty()) return Check(options);
  const SimulationJob job = JobOf(options);
  std::optional<ProgressLine> progress;
  const SimulationCounts counts = Simulate(job, make_bench, [&](int done, int total) {
    if (!progress) progress.emplace("moments", total);
    progress->Update(done);
  });
  progress.reset();
  fmt::print("{}: {} recordings, {} images, {} frames of markers; the answer is sealed in {}\n",
             job.out.string(), counts.recordings, counts.images, counts.marker_frames,
             job.answer.string());
  return app::kExitDone;
}

app::Verb SimulateVerb() {
  return {"simulate", "Make an experiment on the virtual bench, with a sealed answer",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<SimulateOptions>();
            arguments.Positional("ROBOT", &options->robot,
                                 "robot file, or the name of a robot that comes with palpate",
                                 app::Need::kOptional);
            arguments.Option(
                "--scenario", &options->scenario,
                "what the bench is made of and what is done (libs/scenario/README.md)");
            arguments.Option("--seed", &options->seed, 0, std::numeric_limits<int>::max(),
                             "draws noise, clutter and what the scenario leaves open");
            arguments.Option("--out", &options->out, "experiment folder to make");
            arguments.Option("--answer", &options->answer,
                             "file of the sealed answer; else beside the experiment, "
                             "EXP.answer.json");
            arguments.Flag("--tell-camera-pose", &options->tell_camera_pose,
                           "write the planned T_robot_camera into experiment.yaml");
            arguments.Option("--check", &options->check,
                             "experiment: is --answer the one that was sealed with it?");
            return [options] { return SimulateOrCheck(*options); };
          }};
}

}  // namespace palpate::command
