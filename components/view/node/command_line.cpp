// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/command_line.hpp"

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "components/view/access_settings.hpp"
#include "libs/app/log.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/version.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/recording/recorded_messages.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::view {

namespace {

constexpr const char* kForcesFile = "forces.csv";
constexpr const char* kDiagnosedRobotFile = "robot.extended.yaml";

std::unique_ptr<KnownRobot> KnownRobotOf(const std::filesystem::path& robot_file) {
  if (robot_file.empty()) return nullptr;
  return std::make_unique<KnownRobot>(
      robot::BuildRobotBody(robot::ReadRobotFile(robot_file, app::LoadYaml)));
}

bool IsExperiment(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "experiment.yaml") ||
         std::filesystem::exists(folder / "recording.yaml");
}

/// By its name: that it is one, its reader says.
bool IsRobotFile(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

/// forces.csv under any name, or in a folder; empty: there is none.
std::filesystem::path ForcesFileOf(const std::filesystem::path& results) {
  if (std::filesystem::is_regular_file(results)) return results;
  const std::filesystem::path in_folder = results / kForcesFile;
  return !results.empty() && std::filesystem::exists(in_folder) ? in_folder
                                                                : std::filesystem::path();
}

std::unique_ptr<ShownExperiment> ExperimentOf(const Command& command) {
  if (!IsExperiment(command.recording)) {
    if (command.results.empty()) return nullptr;
    throw InputError("--results: they belong to an experiment folder, and none is shown");
  }
  auto shown = std::make_unique<ShownExperiment>();
  shown->experiment = experiment::ReadExperiment(command.recording, app::LoadYaml);
  if (const auto forces = ForcesFileOf(command.results); !forces.empty()) {
    shown->forces = EstimatedForces::Read(forces);
  }
  for (std::size_t r = 0; r < shown->experiment.recordings.size(); ++r) {
    const experiment::Recording& recording = shown->experiment.recordings[r];
    if (recording.depth_images.empty() && recording.clouds.empty()) continue;
    shown->sequences.emplace(r, experiment::OpenRecordingImages(recording, app::LoadYaml));
  }
  return shown;
}

/// The robot file that is given, else that of a diagnosis, else that of the experiment.
std::filesystem::path RobotFileOf(const Command& command, const ShownExperiment* shown) {
  if (IsRobotFile(command.recording)) {
    if (command.robot.empty()) return command.recording;
    throw InputError("--robot: " + command.recording.string() +
                     " is a robot file, which is shown by itself: leave --robot out");
  }
  if (!command.robot.empty()) return app::FindRobotFile(command.robot);
  const std::filesystem::path diagnosed = command.results / kDiagnosedRobotFile;
  if (!command.results.empty() && std::filesystem::exists(diagnosed)) return diagnosed;
  if (!command.results.empty() && !shown->forces) {
    throw InputError("--results: " + command.results.string() + " holds neither " + kForcesFile +
                     " of `palpate estimate` nor " + kDiagnosedRobotFile +
                     " of `palpate diagnose`");
  }
  if (!command.config.robot.empty()) return app::FindRobotFile(command.config.robot);
  if (shown == nullptr) return {};
  if (shown->experiment.robot) return *shown->experiment.robot;
  throw InputError(command.recording.string() +
                   ": experiment.yaml names no robot; name one with --robot ROBOT");
}

RecorderControl::Settings RecorderOf(const Command& command,
                                     const std::filesystem::path& robot_file) {
  RecorderControl::Settings recorder;
  recorder.allowed = command.config.allow_control;
  recorder.program = app::ProgramFolder() / "palpate-recorder";
  recorder.folder = command.config.record_folder.empty() ? std::filesystem::current_path()
                                                         : command.config.record_folder;
  if (recorder.allowed && !std::filesystem::is_directory(recorder.folder)) {
    throw InputError("record_folder: " + recorder.folder.string() +
                     " is no folder; make it, or name another one");
  }
  recorder.arguments = {"--domain", std::to_string(command.options.domain_id)};
  if (!robot_file.empty()) {
    recorder.arguments.insert(recorder.arguments.end(), {"--robot", robot_file.string()});
  }
  return recorder;
}

/// A path that ends in a slash has no last name.
std::string SourceNameOf(const Command& command) {
  const std::filesystem::path source = (command.recording / "").parent_path();
  std::string name = source.filename().string();
  if (!command.results.empty())
    name += ", " + (command.results / "").parent_path().filename().string();
  return name;
}

std::vector<std::filesystem::path> RecordingFiles(const std::filesystem::path& recording) {
  if (recording.empty() || IsExperiment(recording) || IsRobotFile(recording)) return {};
  std::vector<std::filesystem::path> files = recording::MessageFilesOf(recording);
  if (files.empty()) {
    throw InputError("--recording: " + recording.string() +
                     " holds no recorded messages (.mcap, .db3), and is neither an experiment "
                     "folder nor a robot file (.yaml)");
  }
  return files;
}

}  // namespace

void DeclareResults(app::Arguments& arguments, Command* command) {
  arguments.Option("--results PATH", &command->results,
                   "With an experiment folder: forces.csv of `palpate estimate`, whose forces act "
                   "on the model, or the folder of `palpate diagnose`, whose robot is shown");
}

void DeclareView(app::Arguments& arguments, Command* command) {
  app::DeclareRobot(arguments, &command->robot, app::Need::kOptional);
  arguments.Option("--recording FILE", &command->recording,
                   "Show recorded messages (.mcap, .db3, or a folder of them), an experiment "
                   "folder or a robot file instead of the running system");
  DeclareResults(arguments, command);
}

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments("palpate-view", "Show the running system in a browser and in Foxglove");
  DeclareView(arguments, &command);
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  return command;
}

std::unique_ptr<ViewNode> MakeNode(const Command& command) {
  std::unique_ptr<ShownExperiment> experiment = ExperimentOf(command);
  const std::filesystem::path robot_file = RobotFileOf(command, experiment.get());
  const char* token = std::getenv(kTokenVariable);
  ViewPlan plan;
  plan.token = TokenOf(command.config.http, token == nullptr ? "" : token);
  plan.version = app::Version();
  plan.recording = RecordingFiles(command.recording);
  plan.source_name = SourceNameOf(command);
  plan.robot = KnownRobotOf(robot_file);
  plan.experiment = std::move(experiment);
  plan.robot_alone = IsRobotFile(command.recording);
  plan.recorder = RecorderOf(command, robot_file);
  return std::make_unique<ViewNode>(
      command.config, std::move(plan), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::view
