// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/command_line.hpp"

#include <optional>
#include <string>
#include <vector>

#include "libs/app/log.hpp"
#include "libs/app/yaml.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::perception {

namespace {

/// Poses in the settings override those of the file.
PoseOrigin TakeCalibrationFile(const std::filesystem::path& file,
                               std::optional<Eigen::Isometry3d>* T_robot_camera,
                               std::vector<dds::FurtherCamera>* cameras) {
  const robot::CalibrationFile calibration = robot::ReadCalibrationFile(file, app::LoadYaml);
  if (*T_robot_camera && calibration.pose) {
    app::LogWarning("camera_pose is set: that of --calibration does not count");
  } else if (calibration.pose) {
    *T_robot_camera = calibration.pose->T_robot_camera;
  }
  std::vector<dds::FurtherCamera> calibrated;
  for (const robot::CalibratedCamera& camera : calibration.cameras) {
    calibrated.push_back({camera.name, camera.pose.T_robot_camera});
  }
  const std::string unknown = dds::TakePoses(calibrated, file.string(), cameras);
  if (!unknown.empty()) app::LogWarning("{}", unknown);
  return {calibration.mesh_hash, calibration.date_utc};
}

}  // namespace

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  std::string camera_pose;
  app::Arguments arguments(
      "palpate-perception",
      "Segment the robot, objects and contacts in the frames of an RGB-D camera");
  arguments.Option("--calibration", &command.calibration,
                   "Calibration file of palpate calibrate, for the poses of the cameras");
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
  auto cameras = dds::ReadFurtherCameras(command.config.cameras, app::ParseYaml);
  PoseOrigin origin;
  if (!command.calibration.empty()) {
    origin = TakeCalibrationFile(command.calibration, &T_robot_camera, &cameras);
  }
  return std::make_unique<PerceptionNode>(
      command.config, T_robot_camera, MakeFramePerception, command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log, cameras,
      origin);
}

}  // namespace palpate::perception
