// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <variant>

#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/recording_frames.hpp"
#include "components/palpate/calibrate/calibrate_ways.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

using calibration::FittedValue;
using calibration::JointCalibration;
using experiment::Recording;

bool IsOfTheCamera(const experiment::Experiment& experiment, const Recording& recording) {
  return recording.markers && !recording.T_robot_camera &&
         experiment::FrameOf(experiment, recording) == experiment::MeasurementFrame::kCamera &&
         recording.kind != experiment::RecordingKind::kCameraMoved &&
         (recording.camera_on_base || !recording.base_tilt_deg);
}

/// All in the camera's frame with the camera where it always stood, and without unknown contacts.
std::vector<const Recording*> RecordingsOfTheCamera(const experiment::Experiment& experiment) {
  std::vector<const Recording*> chosen;
  for (const Recording& recording : experiment.recordings) {
    if (recording.kind == experiment::RecordingKind::kFree) continue;
    if (IsOfTheCamera(experiment, recording)) chosen.push_back(&recording);
  }
  if (chosen.empty()) {
    throw InputError(experiment.folder.string() +
                     ": no recording serves to find the camera: it needs markers.csv in the "
                     "camera's frame (frame: camera) and a kind other than 'free' and "
                     "'camera_moved'");
  }
  return chosen;
}

const FittedValue* Find(const JointCalibration& fit, const std::string& name) {
  const auto found = std::find_if(fit.values.begin(), fit.values.end(),
                                  [&](const FittedValue& value) { return value.name == name; });
  return found == fit.values.end() ? nullptr : &*found;
}

void TakeDrives(const JointCalibration& fit, const robot::RobotModel& model,
                robot::CalibrationFile* file) {
  for (const std::string& cable : model.CableNames()) {
    const FittedValue* offset = Find(fit, "cable_offset:" + cable);
    const FittedValue* gain = Find(fit, "cable_gain:" + cable);
    robot::CalibratedDrive drive{.cable = cable, .drive = {}, .standard_error = {}};
    if (offset != nullptr && offset->determined) {
      drive.drive.offset_m = offset->value;
      drive.standard_error.offset_m = offset->standard_error;
    }
    if (gain != nullptr && gain->determined) {
      drive.drive.gain = gain->value;
      drive.standard_error.gain = gain->standard_error;
    }
    if ((offset != nullptr && offset->determined) || (gain != nullptr && gain->determined)) {
      file->drives.push_back(drive);
    }
  }
}

void TakePose(const JointCalibration& fit, robot::CalibrationFile* file) {
  robot::CalibratedPose pose;
  pose.T_robot_camera =
      Eigen::Translation3d(fit.T_robot_camera.translation_m()) * fit.T_robot_camera.rotation();
  const Eigen::Matrix<double, 6, 1> errors = fit.pose_covariance.diagonal().cwiseSqrt();
  pose.rotation_error_rad = errors.head<3>();
  pose.translation_error_m = errors.tail<3>();
  file->pose = pose;
}

void PrintFit(const JointCalibration& fit, const std::vector<std::string>& frames) {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    fmt::print("{}: markers off by {:.3f} mm RMS\n", frames[f],
               1e3 * fit.residual_rms_of_frame_m[f]);
  }
  for (const FittedValue& value : fit.values) {
    if (!value.name.starts_with("input:")) continue;
    fmt::print("{}: {:.4f} {} (standard error {:.4f} {})\n", value.name, value.value, value.unit,
               value.standard_error, value.unit);
  }
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} iterations\n", fit.chi_squared,
             fit.degrees_of_freedom, fit.iterations);
}

}  // namespace

bool NeedsCameraPose(const experiment::Experiment& experiment) {
  return !experiment.T_robot_camera &&
         std::any_of(
             experiment.recordings.begin(), experiment.recordings.end(),
             [&](const Recording& recording) { return IsOfTheCamera(experiment, recording); });
}

robot::CalibrationFile CalibrateCamera(const CalibrateOptions& options,
                                       const experiment::Experiment& experiment,
                                       const std::vector<int>& materials,
                                       robot::RobotModel* model) {
  const auto chosen = options.recordings.empty() ? RecordingsOfTheCamera(experiment)
                                                 : ChooseRecordings(experiment, options.recordings);
  std::vector<calibration::CalibrationFrame> frames;
  std::vector<std::string> names;
  for (const Recording* recording : chosen) {
    for (auto& frame : calibration::FramesOfRecording(experiment, *recording, *model,
                                                      ParseCableInput(options.cable_input),
                                                      options.marker_bias_m)) {
      names.push_back(frame.name);
      frames.push_back(std::move(frame));
    }
  }
  const calibration::JointRequest request{.drive_offset_sigma_m = options.drive_offset_sigma_m,
                                          .drive_gains = options.drive_gains,
                                          .moduli = materials};
  const JointCalibration fit =
      calibration::CalibrateFrames(*model, std::move(frames), nullptr, request);
  RequireFit(fit.status);
  robot::CalibrationFile file = MakeCalibration(*model, chosen, options.data);
  TakePose(fit, &file);
  TakeDrives(fit, *model, &file);
  for (const int material : materials) {
    const std::string part = PartName(model->body(), material);
    const FittedValue* modulus = Find(fit, "youngs_modulus:" + part);
    if (modulus != nullptr && modulus->determined) {
      file.moduli.push_back({part, modulus->value, modulus->standard_error});
    }
  }
  for (const FittedValue& value : fit.values) {
    if (!value.determined) file.undetermined.push_back({value.name, value.what_would_tell});
  }
  TakeQuality(fit, &file);
  if (!options.json) PrintFit(fit, names);
  return file;
}

}  // namespace palpate::command
