// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate_verb.hpp"

#include <fmt/core.h>

#include <limits>
#include <memory>
#include <optional>

#include "components/palpate/check_output.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/progress_line.hpp"
#include "components/palpate/simulate/sealed_answer.hpp"
#include "components/palpate/simulate/simulation.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
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
    throw InputError("--check takes no other option than --answer: it simulates nothing");
  }
  const std::filesystem::path answer = AnswerFile(options, options.check);
  CheckSeal(options.check, answer);
  fmt::print("{} is the ground truth that was stored with {}\n", answer.string(),
             options.check.string());
  return app::kExitDone;
}

SimulationJob JobOf(const SimulateOptions& options) {
  if (options.robot.empty()) throw InputError("ROBOT is required; see palpate simulate --help");
  if (options.scenario.empty())
    throw InputError("--scenario is required; see palpate simulate --help");
  if (options.out.empty()) throw InputError("--out is required; see palpate simulate --help");
  SimulationJob job;
  job.robot = robot::ReadRobotFile(FindRobotFile(options.robot), app::LoadYaml);
  job.scenario = scenario::ReadScenario(options.scenario, app::LoadYaml);
  job.seed = static_cast<std::uint64_t>(options.seed);
  job.out = options.out;
  job.answer = AnswerFile(options, options.out);
  job.tell_camera_pose = options.tell_camera_pose;
  CheckOutputFolder(job.out);
  // Beside an experiment whose folder is yet to be made there is no folder either.
  if (!options.answer.empty()) CheckOutputFile(job.answer);
  return job;
}

}  // namespace

int SimulateOrCheck(const SimulateOptions& options, const MakeBench& make_bench) {
  if (!options.check.empty()) return Check(options);
  const SimulationJob job = JobOf(options);
  std::optional<ProgressLine> progress;
  const app::StopSignal stop;
  const SimulationCounts counts = Simulate(job, make_bench, [&](int done, int total) {
    if (!progress) progress.emplace("samples", total);
    progress->Update(done);
    if (!stop.Requested()) return;
    progress->Clear();
    throw app::Interrupted(fmt::format("after {} of {} samples: nothing was written", done, total));
  });
  progress.reset();
  fmt::print("{}: {} recordings, {} images, {} marker frames; ground truth in {}\n",
             job.out.string(), counts.recordings, counts.images, counts.marker_frames,
             job.answer.string());
  return app::kExitDone;
}

app::Verb SimulateVerb() {
  return {"simulate",
          "Generate a synthetic data set with the virtual robot; the ground truth is stored with a "
          "hash",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<SimulateOptions>();
            DeclareRobot(arguments, &options->robot, app::Need::kOptional);
            arguments.Option("--scenario", &options->scenario,
                             "Scenario file: sensors, commands, loads and hidden effects "
                             "(libs/scenario/README.md); required to simulate");
            arguments.Option("--seed", &options->seed, 0, std::numeric_limits<int>::max(),
                             "Random seed (noise, manufacturing tolerances, unspecified effects)");
            arguments.Option("--out FOLDER", &options->out,
                             "Experiment folder to create; required to simulate");
            arguments.Option("--answer", &options->answer,
                             "File of the ground truth; without it EXPERIMENT.answer.json beside "
                             "the experiment folder");
            arguments.Flag("--tell-camera-pose", &options->tell_camera_pose,
                           "Store the nominal camera pose as T_robot_camera in experiment.yaml");
            arguments.Option("--check FOLDER", &options->check,
                             "Simulate nothing: check that the ground truth is the one stored "
                             "with this experiment");
            return [options] { return SimulateOrCheck(*options); };
          }};
}

}  // namespace palpate::command
