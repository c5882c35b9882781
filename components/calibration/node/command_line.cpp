// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/command_line.hpp"

#include <filesystem>
#include <string>
#include <utility>

#include "libs/app/log.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::calibration {

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments("palpate-calibration",
                           "Finds, when asked, where the camera stands and how the drives are read "
                           "from the running robot.");
  arguments.Positional("ROBOT", &command.robot, "Robot file", app::Need::kOptional);
  std::string out, camera_pose;
  arguments.Option("--out", &out, "Same as --set calibration_file=...");
  arguments.Option("--camera-pose", &camera_pose, "Same as --set camera_pose=...");
  app::DeclareNodeOptions(arguments, &command.options);
  if (!arguments.Parse(app::CommandLineWords(argc, argv)) ||
      !app::SettleNodeOptions(app::ListSettings(command.config), &command.options)) {
    return std::nullopt;
  }
  if (!out.empty()) command.config.calibration_file = out;
  if (!camera_pose.empty()) command.config.camera_pose = camera_pose;
  if (command.robot.empty()) throw InputError("ROBOT is required: a robot file");
  return command;
}

std::unique_ptr<CalibrationNode> MakeNode(const Command& command) {
  auto body = robot::BuildRobotBody(robot::ReadRobotFile(command.robot, app::LoadYaml));
  if (const std::filesystem::path last = command.config.calibration_file;
      !last.empty() && std::filesystem::exists(last)) {
    robot::ApplyGeometry(robot::ReadCalibrationFile(last, app::LoadYaml), &body);
  }
  for (const std::string& note : body.notes) app::LogInfo("{}", note);
  auto model = std::make_unique<robot::RobotModel>(
      std::move(body), fem::StaticSettings{},
      fem::SolverSettings{command.config.solver, command.config.threads});
  return std::make_unique<CalibrationNode>(
      command.config, std::move(model), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::calibration
