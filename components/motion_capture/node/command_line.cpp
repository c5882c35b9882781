// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/motion_capture/node/command_line.hpp"

#include <string>

#include "libs/app/log.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::motion_capture {

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  std::string pose;
  app::Arguments arguments("palpate-motion-capture",
                           "Publish the markers of a motion-capture server (NatNet)");
  arguments.Option("--mocap-pose POSE", &pose,
                   "Pose T_robot_mocap of the motion capture's frame; same as T_robot_mocap of the "
                   "settings");
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  if (!pose.empty()) command.config.T_robot_mocap = pose;
  return command;
}

std::unique_ptr<MotionCaptureNode> MakeNode(const Command& command) {
  const std::string& pose = command.config.T_robot_mocap;
  if (pose.empty()) {
    throw InputError(
        "--mocap-pose is required: how does the frame of the motion capture stand to the robot?");
  }
  std::optional<geometry::PoseStandardError> stated;
  const Eigen::Isometry3d T_robot_mocap =
      geometry::ReadMeasuredPose(app::ParseYaml(pose, "T_robot_mocap"), &stated);
  return std::make_unique<MotionCaptureNode>(
      command.config, T_robot_mocap, stated.value_or(geometry::PoseStandardError()),
      command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::motion_capture
