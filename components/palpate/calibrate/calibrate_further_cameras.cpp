// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "components/calibration/cloud/join_frames.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/calibration/joint/request_after.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/cameras.hpp"

namespace palpate::command {

namespace {

/// A camera beside the first, fitted to its own images.
struct FittedAlone {
  std::string name;
  ImageCalibration images;
};

void NoteLeftOut(const std::string& name, const std::string& why) {
  fmt::print(stderr, "note: camera '{}' is not calibrated: {}\n", name, why);
}

/// The options but for those of the first camera's pose.
CalibrateOptions OfFurtherCamera(CalibrateOptions options) {
  options.camera_pose.clear();
  options.earlier.clear();
  return options;
}

/// Each against the robot of `file`, to which they are added. The model is unchanged.
std::vector<FittedAlone> FitEachAlone(const CalibrateOptions& options,
                                      const experiment::Experiment& experiment,
                                      const std::vector<std::string>& names,
                                      robot::RobotModel* model, robot::CalibrationFile* file) {
  const calibration::ModelSnapshot nominal(*model);
  robot::ApplyCalibration(*file, model);
  experiment::Experiment corrected = experiment;
  offline::CorrectPressures(*file, &corrected);
  std::vector<FittedAlone> fitted;
  for (const std::string& name : names) {
    const experiment::Experiment alone = experiment::OfCamera(corrected, name);
    if (!alone.T_robot_camera) {
      NoteLeftOut(name, "give its approximate pose in 'cameras' of experiment.yaml");
      continue;
    }
    if (options.recordings.empty() && !HasImagesOfTheCamera(alone)) {
      NoteLeftOut(name, "no recording of a suitable kind has its images");
      continue;
    }
    if (!options.json) fmt::print("camera '{}':\n", name);
    calibration::CloudSettings clouds;
    clouds.request = calibration::RequestAfter(*file);
    clouds.request.pose_prior = PriorOf(options, alone);
    try {
      ImageCalibration images = FitImages(options, alone, *alone.T_robot_camera, clouds, model);
      if (!options.json) Describe(images, options, *model);
      file->cameras.push_back(calibration::CameraOf(name, images.fit.joint, images.picture));
      images.recordings.clear();  // of `alone`
      fitted.push_back({name, std::move(images)});
    } catch (const RunError& error) {
      throw RunError("camera '" + name + "': " + error.what());
    }
  }
  nominal.Restore();
  return fitted;
}

/// A camera's clouds with the inputs that were recorded, without what a calibration corrects.
std::vector<calibration::CloudFrame> AsRecorded(const std::vector<calibration::CloudFrame>& frames,
                                                const CameraImages& recorded) {
  std::vector<calibration::CloudFrame> plain;
  for (const offline::ImageSample& sample : recorded.samples) {
    const auto seen = std::find_if(frames.begin(), frames.end(), [&](const auto& frame) {
      return frame.name == sample.frame.name;
    });
    if (seen == frames.end()) continue;
    plain.push_back(sample.frame);
    plain.back().cloud = seen->cloud;
  }
  return plain;
}

/// The fit of all cameras from the poses of fits to each.
ImageCalibration FitAll(const CalibrateOptions& options, const experiment::Experiment& experiment,
                        const std::vector<FittedAlone>& further, const ImageCalibration& first,
                        robot::RobotModel* model) {
  ImageCalibration all{.recordings = first.recordings,
                       .picture = first.picture,
                       .frames = {},
                       .clouds = first.clouds,
                       .fit = {}};
  std::vector<std::vector<calibration::CloudFrame>> frames;
  for (const FittedAlone& camera : further) {
    const experiment::Experiment alone = experiment::OfCamera(experiment, camera.name);
    frames.push_back(AsRecorded(camera.images.frames, OpenCameraImages(options, alone, *model)));
    all.clouds.further_cameras.push_back(
        {.name = camera.name,
         .T_robot_camera_start = camera.images.fit.joint.T_robot_camera,
         .pose_prior = camera.images.clouds.request.pose_prior,
         .fit_depth_bias = camera.images.clouds.fit_depth_bias});
  }
  all.frames = calibration::JoinFrames(first.frames, frames);
  all.fit = calibration::CalibrateFromClouds(*model, all.frames, first.fit.joint.T_robot_camera,
                                             all.clouds);
  return all;
}

/// Why not to use a fit of all cameras; empty: it is used.
std::string WhyNotAll(const calibration::CloudCalibration& first,
                      const calibration::CloudCalibration& all) {
  if (!all.status.ok()) return all.status.message();
  if (calibration::AgreesWith(first.joint, all.joint)) return {};
  return fmt::format(
      "they contradict each other, chi-squared {:.3g} for {} degrees of freedom, {:.3g} for {} of "
      "the first. Likely reasons: clocks differ, or a camera or the robot moved",
      all.joint.chi_squared, all.joint.degrees_of_freedom, first.joint.chi_squared,
      first.joint.degrees_of_freedom);
}

}  // namespace

void CalibrateFurtherCameras(const CalibrateOptions& options,
                             const experiment::Experiment& experiment, robot::RobotModel* model,
                             FoundCalibration* found) {
  const std::vector<std::string> names = experiment::FurtherCameras(experiment);
  if (names.empty()) return;
  const CalibrateOptions own = OfFurtherCamera(options);
  const std::vector<FittedAlone> further =
      FitEachAlone(own, experiment, names, model, &found->file);
  if (further.empty() || !found->images) return;
  const ImageCalibration all = FitAll(own, experiment, further, *found->images, model);
  if (const std::string why_not = WhyNotAll(found->images->fit, all.fit); !why_not.empty()) {
    fmt::print(stderr,
               "note: the cameras are calibrated one after the other, since one fit of all "
               "failed: {}\n",
               why_not);
    return;
  }
  if (!options.json) fmt::print("all cameras in one fit:\n");
  robot::CalibrationFile file = Describe(all, options, *model);
  for (std::size_t k = 0; k < further.size(); ++k) {
    file.cameras.push_back(calibration::CameraOf(further[k].name, all.fit.joint.further_cameras[k],
                                                 further[k].images.picture));
  }
  TakeUndeterminedModuli(found->file.undetermined, &file);
  found->file = std::move(file);
}

}  // namespace palpate::command
