// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/image_check.hpp"

#include <algorithm>
#include <string>
#include <variant>

#include "components/offline/images/image_misfit.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::offline {

namespace {

using experiment::Recording;

/// Of the images that `recording` itself has, those of `camera`, empty: the first.
void RequireFitOf(const ImageCheck& check, const experiment::Experiment& experiment,
                  const Recording& recording, const std::string& camera, bool may_be_touched) {
  if (recording.depth_images.empty() && recording.clouds.empty()) return;
  const auto pose = experiment::RobotFromCamera(experiment, recording);
  if (!std::holds_alternative<Eigen::Isometry3d>(pose)) return;
  const auto& T_robot_camera = std::get<Eigen::Isometry3d>(pose);
  const experiment::RgbdSequence images = check.open(recording);
  const calibration::DepthMisfitRequest request{
      .pose_name = recording.T_robot_camera ? "T_robot_camera of recording.yaml" : check.pose_name,
      .T_robot_camera = {Eigen::Quaterniond(T_robot_camera.linear()), T_robot_camera.translation()},
      .translation_sigma_m = check.pose_error.translation_m,
      .rotation_sigma_rad = check.pose_error.rotation_rad,
      .may_be_touched = may_be_touched};
  const calibration::DepthMisfit misfit = FindImageMisfit(
      {SampleAt(recording, images, 0, recording.name, *check.model, check.cable_input)},
      check.noise, request, check.model);
  if (misfit.fits) return;
  throw RunError(recording.name + (camera.empty() ? "" : ", camera '" + camera + "'") + ": " +
                 MisfitText(misfit.reasons, "no forces were estimated"));
}

void RequireFit(const ImageCheck& check, const Recording& recording, bool may_be_touched) {
  const experiment::Experiment& experiment = check.experiment;
  RequireFitOf(check, experiment, recording, "", may_be_touched);
  for (const experiment::CameraFiles& camera : recording.cameras) {
    RequireFitOf(check, experiment::OfCamera(experiment, camera.name),
                 experiment::OfCamera(experiment, recording, camera.name), camera.name,
                 may_be_touched);
  }
}

}  // namespace

void RequireImagesFit(const ImageCheck& check, const std::vector<PlannedRecording>& plan) {
  const std::vector<const Recording*> contact_free = BiasRecordings(check.experiment);
  if (!contact_free.empty()) RequireFit(check, *contact_free.front(), /*may_be_touched=*/false);
  for (const PlannedRecording& planned : plan) {
    const Recording& recording = *planned.recording;
    // What fits without a contact fits with one, whatever that does to the shape.
    const bool is_known =
        !contact_free.empty() && !recording.T_robot_camera && !contact_free.front()->T_robot_camera;
    const bool is_done = !contact_free.empty() && &recording == contact_free.front();
    if (planned.from != EstimateFrom::kShape || is_known || is_done) continue;
    RequireFit(check, recording, /*may_be_touched=*/true);
  }
}

}  // namespace palpate::offline
