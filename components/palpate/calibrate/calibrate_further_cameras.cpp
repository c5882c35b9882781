// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <string>
#include <vector>

#include "components/calibration/joint/request_after.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/cameras.hpp"

namespace palpate::command {

namespace {

void NoteLeftOut(const std::string& name, const std::string& why) {
  fmt::print(stderr, "note: camera '{}' is not calibrated: {}\n", name, why);
}

/// The options but for those of the first camera's pose.
CalibrateOptions OfFurtherCamera(CalibrateOptions options) {
  options.camera_pose.clear();
  options.earlier.clear();
  return options;
}

}  // namespace

void CalibrateFurtherCameras(const CalibrateOptions& options,
                             const experiment::Experiment& experiment, robot::RobotModel* model,
                             robot::CalibrationFile* file) {
  const std::vector<std::string> names = experiment::FurtherCameras(experiment);
  if (names.empty()) return;
  const CalibrateOptions own = OfFurtherCamera(options);
  robot::ApplyCalibration(*file, model);
  experiment::Experiment corrected = experiment;
  offline::CorrectPressures(*file, &corrected);
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
    clouds.request.pose_prior = PriorOf(own, alone);
    try {
      const ImageCalibration found = FitImages(own, alone, *alone.T_robot_camera, clouds, model);
      const robot::CalibrationFile of_camera = Describe(found, own, *model);
      if (!of_camera.pose) throw RunError("its images do not determine its pose");
      file->cameras.push_back({name, *of_camera.pose, of_camera.depth_bias});
    } catch (const RunError& error) {
      throw RunError("camera '" + name + "': " + error.what());
    }
  }
}

}  // namespace palpate::command
