// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/command_line.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/node/make_pipeline.hpp"
#include "libs/app/log.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/yaml.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::force_estimation {

namespace {

/// The robot, with the geometry of the calibration (nullptr: none).
std::unique_ptr<robot::RobotModel> LoadRobot(const std::filesystem::path& file,
                                             const fem::SolverSettings& solver,
                                             const robot::CalibrationFile* calibration) {
  auto body = robot::BuildRobotBody(robot::ReadRobotFile(file, app::LoadYaml));
  for (const std::string& warning : body.warnings) app::LogWarning("{}", warning);
  for (const std::string& note : body.notes) app::LogInfo("{}", note);
  if (calibration != nullptr) robot::ApplyGeometry(*calibration, &body);
  return std::make_unique<robot::RobotModel>(std::move(body), fem::StaticSettings{}, solver);
}

/// The cameras beside the first, with the poses of the calibration (`file`; empty: none) where the
/// settings give none. A pose in the settings overrides that of the calibration and its depth bias.
std::vector<dds::FurtherCamera> FurtherCamerasOf(const NodeConfig& config, const std::string& file,
                                                 robot::CalibrationFile* calibration) {
  auto cameras = dds::ReadFurtherCameras(config.cameras, app::ParseYaml);
  if (file.empty()) return cameras;
  std::vector<dds::FurtherCamera> calibrated;
  for (const robot::CalibratedCamera& camera : calibration->cameras) {
    calibrated.push_back({camera.name, camera.pose.T_robot_camera});
  }
  std::erase_if(calibration->cameras, [&](const robot::CalibratedCamera& known) {
    return std::any_of(cameras.begin(), cameras.end(), [&](const dds::FurtherCamera& camera) {
      return camera.name == known.name && camera.T_robot_camera;
    });
  });
  const std::string unknown = dds::TakePoses(calibrated, file, &cameras);
  if (!unknown.empty() && IsFromShape(config)) app::LogWarning("{}", unknown);
  return cameras;
}

/// Applies the calibration to the model, and for source=shape its camera pose to the settings. A
/// pose in the settings overrides that of the calibration and its depth bias.
void Calibrate(robot::CalibrationFile* calibration, robot::RobotModel* model, NodeConfig* config) {
  robot::ApplyCalibration(*calibration, model);
  if (!calibration->pose) return;
  if (!config->camera_pose.empty()) {
    app::LogWarning("camera_pose is set: that of --calibration and its depth bias do not count");
    calibration->pose.reset();
    calibration->depth_bias.reset();
  } else if (config->source == "shape") {
    config->camera_pose = geometry::FormatPose(calibration->pose->T_robot_camera);
  }
}

}  // namespace

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments(
      "palpate-force-estimation",
      "Estimate contact forces from the robot's shape or markers and its cables");
  app::DeclareRobotToRun(arguments, &command.robot);
  arguments.Option(
      "--calibration", &command.calibration,
      "Calibration file of palpate calibrate; without it the robot file's moduli hold");
  std::vector<std::string> contacts;
  arguments.Repeated("--contact SITE", &contacts,
                     "Possible contact location \"name: x, y, z[, patch radius]\", m, on the "
                     "undeformed body; without it contacts are searched");
  std::string camera_pose;
  arguments.Option("--camera-pose POSE", &camera_pose,
                   "Camera pose T_robot_camera; same as --set camera_pose=POSE");
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  if (!camera_pose.empty()) command.config.camera_pose = camera_pose;
  auto& sites = command.config.contacts;
  sites.insert(sites.end(), contacts.begin(), contacts.end());
  command.robot = app::RobotFileToRun(command.robot);
  return command;
}

std::unique_ptr<ForceEstimationNode> MakeNode(const Command& command) {
  for (const ContactSite& site : ParseContactSites(command.config.contacts)) {
    if (site.direction.isZero(0.0) || !IsFromShape(command.config)) continue;
    app::LogWarning("the direction of contact '{}' counts for markers only", site.name);
  }
  NodeConfig config = command.config;
  const fem::SolverSettings solver{config.solver, config.threads};
  robot::CalibrationFile calibration;
  std::unique_ptr<robot::RobotModel> model;
  if (command.calibration.empty()) {
    app::LogWarning("no --calibration: the moduli of the robot file are taken as they are");
    model = LoadRobot(command.robot, solver, nullptr);
  } else {
    calibration = robot::ReadCalibrationFile(command.calibration, app::LoadYaml);
    model = LoadRobot(command.robot, solver, &calibration);
    Calibrate(&calibration, model.get(), &config);
  }
  const auto cameras = FurtherCamerasOf(config, command.calibration.string(), &calibration);
  return std::make_unique<ForceEstimationNode>(
      config, std::move(model), calibration, command.options.domain_id,
      dds::LoadTopicTable(config.dds, app::LoadYaml, app::ParseYaml), app::Log, PipelineMaker(),
      cameras);
}

}  // namespace palpate::force_estimation
