// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/recording_frames.hpp"
#include "components/palpate/calibrate/assignment_plot.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/convergence_plot.hpp"
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

/// All in the camera's frame with the camera at its usual pose, and without unknown contacts.
std::vector<const Recording*> RecordingsOfTheCamera(const experiment::Experiment& experiment) {
  std::vector<const Recording*> chosen;
  for (const Recording& recording : experiment.recordings) {
    if (recording.kind == experiment::RecordingKind::kFree) continue;
    if (IsOfTheCamera(experiment, recording)) chosen.push_back(&recording);
  }
  if (chosen.empty()) {
    throw InputError(experiment.folder.string() +
                     ": no recording determines the camera pose: it needs markers.csv in the "
                     "camera's frame (frame: camera) and a kind other than 'free' and "
                     "'camera_moved'");
  }
  return chosen;
}

/// The others are printed alone.
bool IsInFile(const std::string& name) {
  const auto outside = {"input:", "marker_offset:", "depth_scale"};
  return std::none_of(outside.begin(), outside.end(),
                      [&](const char* start) { return name.starts_with(start); });
}

/// The closest of them.
void PrintCorrelated(const std::vector<calibration::CorrelatedValues>& pairs) {
  constexpr std::size_t kMost = 5;
  for (std::size_t k = 0; k < std::min(kMost, pairs.size()); ++k) {
    fmt::print("{} and {} are hardly distinguishable (correlation {:.2f})\n", pairs[k].one,
               pairs[k].other, pairs[k].correlation);
  }
  if (pairs.size() > kMost) {
    fmt::print("{} further pairs have a correlation of {:.2f} or more\n", pairs.size() - kMost,
               std::abs(pairs.back().correlation));
  }
}

/// Correlations of errors that are reported.
constexpr double kClose = 0.9;

void PrintFit(const JointCalibration& fit, const std::vector<std::string>& frames) {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    fmt::print("{}: marker residual {:.3f} mm RMS\n", frames[f],
               1e3 * fit.residual_rms_of_frame_m[f]);
  }
  for (const FittedValue& value : fit.values) {
    if (IsInFile(value.name) || !value.determined) continue;
    const bool length = value.unit == "m";
    const double factor = length ? 1e3 : 1.0;
    const std::string unit = length ? "mm" : value.unit;
    fmt::print("{}: {:.4f} {} (standard error {:.4f} {})\n", value.name, factor * value.value, unit,
               factor * value.standard_error, unit);
  }
  PrintCorrelated(calibration::FindCorrelated(fit, kClose));
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} iterations\n", fit.chi_squared,
             fit.degrees_of_freedom, fit.iterations);
}

}  // namespace

std::vector<const Recording*> ChosenRecordings(const CalibrateOptions& options,
                                               const experiment::Experiment& experiment,
                                               bool camera) {
  if (!options.recordings.empty()) return ChooseRecordings(experiment, options.recordings);
  return camera ? RecordingsOfTheCamera(experiment) : RecordingsWithKnownLoads(experiment);
}

calibration::JointRequest RequestOf(const CalibrateOptions& options,
                                    const std::vector<int>& materials, bool camera) {
  constexpr double kRadians = 0.017453292519943295;
  return {.pose = camera,
          .actuator_offset_sigma_m = options.actuator_offset_sigma_m,
          .actuator_gains = options.actuator_gains,
          .moduli = materials,
          .poissons_ratio_sigma = options.poissons_ratio_sigma,
          .gravity_tilt_sigma_rad = kRadians * options.gravity_tilt_sigma_deg,
          .mass_relative_sigma = options.mass_relative_sigma,
          .geometry_scale_sigma = options.geometry_scale_sigma,
          .cable_route_sigma_m = options.cable_route_sigma_m,
          .cable_eyelet_sigma_m = options.cable_eyelet_sigma_m,
          .depth_scale_sigma = camera ? options.depth_scale_sigma : 0.0,
          .marker_offset_sigma_m = options.marker_offset_sigma_m};
}

bool HasMarkersOfTheCamera(const experiment::Experiment& experiment) {
  return std::any_of(
      experiment.recordings.begin(), experiment.recordings.end(),
      [&](const Recording& recording) { return IsOfTheCamera(experiment, recording); });
}

bool NeedsCameraPose(const experiment::Experiment& experiment) {
  return !experiment.T_robot_camera && HasMarkersOfTheCamera(experiment);
}

robot::CalibrationFile CalibrateJointly(const CalibrateOptions& options,
                                        const experiment::Experiment& experiment,
                                        const std::vector<int>& materials, bool camera,
                                        robot::RobotModel* model) {
  const auto chosen = ChosenRecordings(options, experiment, camera);
  const robot::CableInput preferred = ParseCableInput(options.cable_input);
  std::vector<calibration::CalibrationFrame> frames;
  std::vector<std::string> names;
  for (const Recording* recording : chosen) {
    for (auto& frame :
         camera ? calibration::FramesOfRecording(experiment, *recording, *model, preferred,
                                                 options.marker_bias_m)
                : calibration::RobotFramesOfRecording(experiment, *recording, *model, preferred,
                                                      options.marker_bias_m)) {
      names.push_back(frame.name);
      frames.push_back(std::move(frame));
    }
  }
  if (!options.convergence.empty()) {
    if (!camera) {
      throw InputError(
          "--convergence compares two methods for the camera pose: it needs markers in the "
          "camera's frame (frame: camera)");
    }
    PlotConvergence(frames, model, options.convergence);
  }
  const geometry::RigidTransform here;
  const JointCalibration fit = calibration::CalibrateFrames(
      *model, frames, camera ? nullptr : &here, RequestOf(options, materials, camera));
  RequireFit(fit.status);
  if (!options.assignment.empty()) DrawFrames(options.assignment, frames, fit, *model);
  robot::CalibrationFile file = MakeCalibration(*model, chosen, options.data);
  calibration::TakeFit(fit, *model, &file);
  if (!options.json) PrintFit(fit, names);
  return file;
}

}  // namespace palpate::command
