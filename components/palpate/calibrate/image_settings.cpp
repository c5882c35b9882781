// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/image_settings.hpp"

#include <algorithm>
#include <string>

#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

using experiment::Recording;

bool IsSuitable(const Recording& recording) {
  const bool has_images = !recording.depth_images.empty() || !recording.clouds.empty();
  return recording.camera_file && has_images && !recording.T_robot_camera &&
         recording.kind != experiment::RecordingKind::kFree &&
         recording.kind != experiment::RecordingKind::kCameraMoved &&
         (recording.camera_on_base || !recording.base_tilt_deg);
}

}  // namespace

std::optional<Eigen::Isometry3d> RoughPose(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment) {
  if (options.camera_pose.empty()) return experiment.T_robot_camera;
  return geometry::ReadPose(app::ParseYaml(options.camera_pose, "--camera-pose"));
}

std::optional<Eigen::Isometry3d> EarlierPose(const CalibrateOptions& options,
                                             const robot::RobotModel& model) {
  if (options.earlier.empty()) return std::nullopt;
  const robot::CalibrationFile file = robot::ReadCalibrationFile(options.earlier, app::LoadYaml);
  const Status status = robot::CheckCalibration(file, model);
  if (!status.ok()) throw InputError(options.earlier.string() + ": " + status.message());
  if (!file.pose)
    throw InputError(options.earlier.string() +
                     ": the calibration has no camera pose (T_robot_camera)");
  return file.pose->T_robot_camera;
}

std::optional<calibration::PosePrior> PriorOf(const CalibrateOptions& options,
                                              const experiment::Experiment& experiment) {
  if (!options.camera_pose.empty() || !experiment.T_robot_camera) return std::nullopt;
  const auto error = experiment.T_robot_camera_error.value_or(geometry::PoseStandardError{});
  return calibration::PosePrior{.name = "T_robot_camera of experiment.yaml",
                                .T_robot_camera = ToTransform(*experiment.T_robot_camera),
                                .translation_sigma_m = error.translation_m,
                                .rotation_sigma_rad = error.rotation_rad};
}

geometry::RigidTransform ToTransform(const Eigen::Isometry3d& T) {
  return {Eigen::Quaterniond(T.linear()), T.translation()};
}

std::vector<const Recording*> RecordingsWithImages(const CalibrateOptions& options,
                                                   const experiment::Experiment& experiment) {
  if (!options.recordings.empty()) return ChooseRecordings(experiment, options.recordings);
  std::vector<const Recording*> chosen;
  for (const Recording& recording : experiment.recordings) {
    if (IsSuitable(recording)) chosen.push_back(&recording);
  }
  if (chosen.empty()) {
    throw InputError(
        experiment.folder.string() +
        ": no recording determines the camera pose: it needs depth images or clouds, and a kind "
        "other than 'free' and 'camera_moved'");
  }
  return chosen;
}

bool HasImagesOfTheCamera(const experiment::Experiment& experiment) {
  return std::any_of(experiment.recordings.begin(), experiment.recordings.end(), IsSuitable);
}

}  // namespace palpate::command
