// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/replayed_images.hpp"

#include <algorithm>
#include <variant>

#include "components/offline/forces/estimate_plan.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

namespace {

constexpr double kSamePose = 1e-9;

Eigen::Isometry3d CameraPose(const experiment::Experiment& experiment,
                             const experiment::Recording& recording) {
  const auto pose = experiment::RobotFromCamera(experiment, recording);
  if (const auto* missing = std::get_if<experiment::NeedsCalibration>(&pose)) {
    throw InputError(recording.folder.string() + ": " + missing->reason);
  }
  return std::get<Eigen::Isometry3d>(pose);
}

}  // namespace

ReplayedImages ExamineImages(const std::filesystem::path& data,
                             const std::optional<Eigen::Isometry3d>& calibrated) {
  const auto experiment = experiment::ReadExperiment(data, app::LoadYaml);
  ReplayedImages images;
  for (const experiment::Recording& recording : experiment.recordings) {
    if (!offline::HasImages(recording)) continue;
    const Eigen::Isometry3d T_robot_camera =
        calibrated ? *calibrated : CameraPose(experiment, recording);
    if (images.recordings == 0) images.T_robot_camera = T_robot_camera;
    if (!T_robot_camera.isApprox(images.T_robot_camera, kSamePose)) {
      throw InputError(recording.folder.string() +
                       ": its camera pose differs from that of the recordings before; give one "
                       "recording as --data");
    }
    const auto frames = static_cast<int>(
        recording.depth_images.empty() ? recording.clouds.size() : recording.depth_images.size());
    const bool first = images.recordings++ == 0;
    images.fewest_frames = first ? frames : std::min(frames, images.fewest_frames);
    images.frames += frames;
  }
  if (images.recordings == 0) {
    throw InputError(data.string() + ": no recording has depth images or clouds");
  }
  return images;
}

}  // namespace palpate::command
