// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <utility>

#include "components/calibration/joint/fit_check.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/fit_markers.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

using calibration::CalibrationFrame;
using calibration::JointRequest;

constexpr const char* kOneOfBoth = "Give --from markers or --from images to use one of them";

/// Of the fit to the markers. A modulus that they do not determine is not asked of images, in which
/// the mesh's error passes for one; a pose that contradicts them is no prior.
JointRequest WhatMarkersTell(const MarkerCalibration& markers, const robot::RobotModel& model) {
  JointRequest request = markers.request;
  const std::vector<std::string> parts = calibration::PartNames(model.body());
  std::erase_if(request.moduli, [&](int material) {
    const auto* modulus =
        calibration::FindValue(markers.fit, "youngs_modulus:" + parts.at(At(material)));
    return modulus == nullptr || !modulus->determined;
  });
  const auto& kept = markers.fit.adjusted_poses;
  const auto is_prior = [&](const calibration::AdjustedPose& pose) {
    return pose.name == request.pose_prior->name;
  };
  if (request.pose_prior && std::none_of(kept.begin(), kept.end(), is_prior)) {
    request.pose_prior.reset();
  }
  return request;
}

/// Markers that fit alone must fit together with the images.
void RequireAgreement(const MarkerCalibration& markers, const ImageCalibration& images,
                      const robot::RobotModel& model) {
  std::vector<CalibrationFrame> frames(images.frames.size());
  frames.insert(frames.end(), markers.frames.begin(), markers.frames.end());
  const calibration::FitCheck together = calibration::CheckFit(model, frames, images.fit.joint);
  if (together.possible) return;
  throw RunError(fmt::format(
      "markers and images contradict each other: the markers are {:.2f} mm from the model (RMS) "
      "with the images, {:.2f} mm without. Likely reasons: the frame of the markers is not that "
      "of the depth camera, or the camera moved between the recordings. {}",
      1e3 * together.residual_rms_m, 1e3 * markers.fit.residual_rms_m, kOneOfBoth));
}

/// Where the images' fit begins: at the pose that the markers give, else at an approximate one.
std::optional<Eigen::Isometry3d> StartOf(const CalibrateOptions& options,
                                         const experiment::Experiment& experiment,
                                         const MarkerCalibration& markers,
                                         const robot::RobotModel& model) {
  if (!markers.request.pose) {
    const std::optional<Eigen::Isometry3d> rough = RoughPose(options, experiment);
    return rough ? rough : EarlierPose(options, model);
  }
  const geometry::RigidTransform& found = markers.fit.T_robot_camera;
  return Eigen::Translation3d(found.translation_m()) * found.rotation();
}

/// nullopt where no approximate pose is known.
std::optional<ImageCalibration> FitImagesToo(const CalibrateOptions& options,
                                             const experiment::Experiment& experiment,
                                             const MarkerCalibration& markers,
                                             robot::RobotModel* model) {
  const auto start = StartOf(options, experiment, markers, *model);
  if (!start) {
    fmt::print(stderr,
               "note: the images are left out: no approximate camera pose is known; give "
               "--camera-pose\n");
    return std::nullopt;
  }
  calibration::CloudSettings clouds;
  clouds.request = WhatMarkersTell(markers, *model);
  clouds.marker_frames = markers.frames;
  // Markers beside images are those of another instrument, as palpate diagnose takes them, too.
  for (CalibrationFrame& frame : clouds.marker_frames) frame.by_depth_camera = false;
  if (!markers.request.pose) clouds.request.pose_prior = PriorOf(options, experiment);
  try {
    return FitImages(options, experiment, *start, std::move(clouds), model);
  } catch (const RunError& error) {
    throw RunError(fmt::format("the markers fit the model, the images do not: {}. {}", error.what(),
                               kOneOfBoth));
  }
}

/// Those of the markers first.
std::vector<const experiment::Recording*> AllOf(const MarkerCalibration& markers,
                                                const ImageCalibration& images) {
  std::vector<const experiment::Recording*> all = markers.recordings;
  for (const experiment::Recording* recording : images.recordings) {
    if (std::find(all.begin(), all.end(), recording) == all.end()) all.push_back(recording);
  }
  return all;
}

}  // namespace

void TakeUndeterminedModuli(const std::vector<robot::Undetermined>& undetermined,
                            robot::CalibrationFile* file) {
  const auto has = [&](const std::string& name) {
    return std::any_of(file->undetermined.begin(), file->undetermined.end(),
                       [&](const auto& other) { return other.name == name; }) ||
           std::any_of(file->moduli.begin(), file->moduli.end(), [&](const auto& modulus) {
             return "youngs_modulus:" + modulus.part == name;
           });
  };
  for (const robot::Undetermined& number : undetermined) {
    if (number.name.starts_with("youngs_modulus:") && !has(number.name))
      file->undetermined.push_back(number);
  }
}

FoundCalibration CalibrateTogether(const CalibrateOptions& options,
                                   const experiment::Experiment& experiment,
                                   const std::vector<int>& materials, robot::RobotModel* model) {
  const calibration::ModelSnapshot kept(*model);
  const MarkerCalibration markers = FitRecordedMarkers(options, experiment, materials, model);
  kept.Restore();
  std::optional<ImageCalibration> images = FitImagesToo(options, experiment, markers, model);
  robot::CalibrationFile file = Describe(markers, options, *model);
  if (!images) return {file};
  RequireAgreement(markers, *images, *model);
  images->recordings = AllOf(markers, *images);
  const std::vector<robot::Undetermined> of_markers = file.undetermined;
  file = Describe(*images, options, *model);
  TakeUndeterminedModuli(of_markers, &file);
  return {std::move(file), std::move(images)};
}

}  // namespace palpate::command
