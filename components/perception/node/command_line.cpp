// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/command_line.hpp"

#include <string>

#include "libs/app/log.hpp"
#include "libs/app/yaml.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::perception {

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  std::string camera_pose;
  app::Arguments arguments(
      "palpate-perception",
      "Segment the robot, objects and contacts in the frames of an RGB-D camera");
  arguments.Option("--camera-pose POSE", &camera_pose,
                   "Camera pose T_robot_camera; same as --set camera_pose=POSE");
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  if (!camera_pose.empty()) command.config.camera_pose = camera_pose;
  return command;
}

std::unique_ptr<PerceptionNode> MakeNode(const Command& command) {
  std::optional<Eigen::Isometry3d> T_robot_camera;
  if (!command.config.camera_pose.empty()) {
    T_robot_camera = geometry::ReadPose(app::ParseYaml(command.config.camera_pose, "camera_pose"));
  }
  return std::make_unique<PerceptionNode>(
      command.config, T_robot_camera, MakeFramePerception, command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log,
      dds::ReadFurtherCameras(command.config.cameras, app::ParseYaml));
}

}  // namespace palpate::perception
