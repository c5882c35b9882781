// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/command_line.hpp"

#include <filesystem>
#include <string>
#include <utility>

#include "libs/app/log.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/yaml.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::calibration {

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments(
      "palpate-calibration",
      "Calibrate camera pose and cable actuators of the running robot on request");
  app::DeclareRobotToRun(arguments, &command.robot);
  std::string out, camera_pose;
  arguments.Option("--out FILE", &out,
                   "Calibration file to write; same as --set calibration_file=FILE");
  arguments.Option("--camera-pose POSE", &camera_pose,
                   "Approximate camera pose T_robot_camera; same as --set camera_pose=POSE");
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  if (!out.empty()) command.config.calibration_file = out;
  if (!camera_pose.empty()) command.config.camera_pose = camera_pose;
  command.robot = app::RobotFileToRun(command.robot);
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
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log,
      CalibrateLive, dds::ReadFurtherCameras(command.config.cameras, app::ParseYaml));
}

}  // namespace palpate::calibration
