// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/command_line.hpp"

#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "components/view/access_settings.hpp"
#include "components/view/frames/binary_frame.hpp"
#include "libs/app/log.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/version.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::view {

namespace {

OutMessage CablePathsOf(const std::filesystem::path& robot_file) {
  const robot::RobotDescription robot = robot::ReadRobotFile(robot_file, app::LoadYaml);
  BinaryFrame frame("cable_paths", {{"robot", robot.name}});
  for (const robot::CableSettings& cable : robot.cables) {
    const Eigen::Matrix3Xf path_m = cable.path_m.cast<float>();
    frame.Add(cable.name, std::span(path_m.data(), static_cast<std::size_t>(path_m.size())));
  }
  return BinaryMessage("cable_paths", frame.Bytes());
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

std::vector<std::filesystem::path> RecordingFiles(const std::filesystem::path& recording) {
  if (recording.empty()) return {};
  std::vector<std::filesystem::path> files = recording::MessageFilesOf(recording);
  if (files.empty()) {
    throw InputError("--recording: " + recording.string() +
                     " holds no recorded messages (.mcap, .db3)");
  }
  return files;
}

}  // namespace

void DeclareView(app::Arguments& arguments, Command* command) {
  app::DeclareRobot(arguments, &command->robot, app::Need::kOptional);
  arguments.Option("--recording FILE", &command->recording,
                   "Show recorded messages (.mcap, .db3, or a folder of them) instead of the "
                   "running system");
}

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments("palpate-view", "Show the running system in a browser and in Foxglove");
  DeclareView(arguments, &command);
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  return command;
}

std::unique_ptr<ViewNode> MakeNode(const Command& command) {
  const std::filesystem::path robot = command.robot.empty() ? command.config.robot : command.robot;
  const std::filesystem::path robot_file =
      robot.empty() ? std::filesystem::path() : app::FindRobotFile(robot);
  const char* token = std::getenv(kTokenVariable);
  ViewPlan plan;
  plan.token = TokenOf(command.config.http, token == nullptr ? "" : token);
  plan.version = app::Version();
  plan.recording = RecordingFiles(command.recording);
  plan.recording_name = command.recording.filename().string();
  if (!robot_file.empty()) plan.cable_paths = CablePathsOf(robot_file);
  plan.recorder = RecorderOf(command, robot_file);
  return std::make_unique<ViewNode>(
      command.config, std::move(plan), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::view
