// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/recording_frames.hpp"
#include "components/palpate/calibrate/assignment_plot.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/convergence_plot.hpp"
#include "components/palpate/calibrate/fit_markers.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::command {

namespace {

using calibration::FittedValue;
using calibration::JointCalibration;
using experiment::Recording;

bool IsKept(const Recording& recording) {
  return recording.kind != experiment::RecordingKind::kFree;
}

/// All in the camera's frame with the camera at its usual pose, and without unknown contacts.
std::vector<const Recording*> RecordingsOfTheCamera(const experiment::Experiment& experiment) {
  std::vector<const Recording*> chosen;
  for (const Recording& recording : experiment.recordings) {
    if (IsKept(recording) && calibration::IsOfTheCamera(experiment, recording))
      chosen.push_back(&recording);
  }
  return chosen;
}

/// Those, and static phases that were measured from another known pose.
std::vector<const Recording*> RecordingsOfTheBody(const experiment::Experiment& experiment) {
  std::vector<const Recording*> chosen = RecordingsOfTheCamera(experiment);
  for (const Recording& recording : experiment.recordings) {
    const auto pose = experiment::RobotFromMarkers(experiment, recording);
    const bool known = std::holds_alternative<Eigen::Isometry3d>(pose);
    if (known && !calibration::IsOfTheCamera(experiment, recording) && HasKnownLoads(recording)) {
      chosen.push_back(&recording);
    }
  }
  return chosen;
}

[[noreturn]] void RefuseForCamera(const experiment::Experiment& experiment) {
  throw InputError(experiment.folder.string() +
                   ": no recording determines the camera pose: it needs markers.csv in the "
                   "camera's frame (frame: camera) and a kind other than 'free' and "
                   "'camera_moved'");
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

/// Who asks for single parameters says with `frame: robot` that the frame is known.
void TakeRobotFrameAsExact(calibration::JointRequest* request) {
  constexpr double kExact = 1e-6;  // m, rad
  for (calibration::PosePrior& pose : request->own_poses) {
    if (pose.name != "frame: robot") continue;
    pose.translation_sigma_m = kExact;
    pose.rotation_sigma_rad = kExact;
  }
}

/// Correlations of errors that are reported.
constexpr double kClose = 0.9;

void PrintFit(const JointCalibration& fit,
              const std::vector<calibration::CalibrationFrame>& frames) {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    fmt::print("{}: marker residual {:.3f} mm RMS\n", frames[f].name,
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
  std::vector<calibration::CorrelatedValues> close = calibration::FindCorrelated(fit, kClose);
  std::erase_if(close, [](const calibration::CorrelatedValues& pair) {
    return pair.one.starts_with("marker_offset:") && pair.other.starts_with("marker_offset:");
  });
  PrintCorrelated(close);
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} iterations\n", fit.chi_squared,
             fit.degrees_of_freedom, fit.iterations);
}

std::vector<calibration::CalibrationFrame> FramesOfTheCamera(
    const std::vector<calibration::CalibrationFrame>& frames) {
  std::vector<calibration::CalibrationFrame> chosen;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(chosen),
               [](const calibration::CalibrationFrame& frame) { return frame.own_pose < 0; });
  if (chosen.empty()) {
    throw InputError(
        "--convergence compares two methods for the camera pose: it needs markers in the "
        "camera's frame (frame: camera)");
  }
  return chosen;
}

}  // namespace

std::vector<const Recording*> ChosenRecordings(const CalibrateOptions& options,
                                               const experiment::Experiment& experiment,
                                               bool camera) {
  if (!options.recordings.empty()) return ChooseRecordings(experiment, options.recordings);
  const auto chosen = camera ? RecordingsOfTheCamera(experiment) : RecordingsOfTheBody(experiment);
  if (!chosen.empty()) return chosen;
  if (!camera) return RecordingsWithKnownLoads(experiment);  // says why none serves
  RefuseForCamera(experiment);
}

calibration::JointRequest RequestOf(const CalibrateOptions& options,
                                    const experiment::Experiment& experiment,
                                    const std::vector<int>& materials, bool camera) {
  constexpr double kRadians = 0.017453292519943295;
  const bool sensors = options.what != "material";
  return {.pose = camera,
          .pose_prior = camera ? PriorOf(options, experiment) : std::nullopt,
          .actuator_offsets = sensors,
          .actuator_offset_sigma_m = options.actuator_offset_sigma_m,
          .actuator_gains = options.actuator_gains,
          .pressure_zero_sigma_Pa = sensors ? options.pressure_zero_sigma_Pa : 0.0,
          .pressure_gain_sigma = sensors ? options.pressure_gain_sigma : 0.0,
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
  return std::any_of(experiment.recordings.begin(), experiment.recordings.end(),
                     [&](const Recording& recording) {
                       return calibration::IsOfTheCamera(experiment, recording);
                     });
}

void LeaveOutMarkerOffsets(const CalibrateOptions& options, robot::CalibrationFile* file) {
  if (options.marker_offset_sigma_m > 0.0) return;
  std::erase_if(file->undetermined, [](const robot::Undetermined& number) {
    return number.name.starts_with("marker_offset:");
  });
}

MarkerCalibration FitRecordedMarkers(const CalibrateOptions& options,
                                     const experiment::Experiment& experiment,
                                     const std::vector<int>& materials, robot::RobotModel* model) {
  MarkerCalibration found;
  found.recordings = ChosenRecordings(options, experiment, options.what == "camera");
  calibration::RecordedFrames recorded(experiment, *model, ParseCableInput(options.cable_input),
                                       options.marker_bias_m);
  for (const Recording* recording : found.recordings) {
    RequireLoads(*recording);
    recorded.Add(*recording, calibration::IsOfTheCamera(experiment, *recording));
  }
  if (options.what == "camera" && !recorded.has_camera()) RefuseForCamera(experiment);
  found.frames = recorded.frames();
  if (!options.convergence.empty()) {
    PlotConvergence(FramesOfTheCamera(found.frames), model, options.convergence);
  }
  found.request = RequestOf(options, experiment, materials, recorded.has_camera());
  found.request.own_poses = recorded.own_poses();
  if (options.what == "joint") TakeRobotFrameAsExact(&found.request);
  if (recorded.has_reference() && !(found.request.marker_offset_sigma_m > 0.0)) {
    found.request.marker_offset_sigma_m = calibration::OffsetOfMarkers_m(*model);
  }
  found.fit = FitMarkers(found.frames, found.request, model);
  if (!options.assignment.empty()) {
    DrawFrames(options.assignment, found.frames, found.fit, *model);
  }
  return found;
}

robot::CalibrationFile Describe(const MarkerCalibration& found, const CalibrateOptions& options,
                                const robot::RobotModel& model) {
  robot::CalibrationFile file = calibration::MakeCalibration(model, found.recordings, options.data);
  calibration::TakeFit(found.fit, model, &file);
  LeaveOutMarkerOffsets(options, &file);
  NameKnownLoads(found.recordings, &file);
  RequireSomething(file);
  if (!options.json) PrintFit(found.fit, found.frames);
  return file;
}

robot::CalibrationFile CalibrateJointly(const CalibrateOptions& options,
                                        const experiment::Experiment& experiment,
                                        const std::vector<int>& materials,
                                        robot::RobotModel* model) {
  return Describe(FitRecordedMarkers(options, experiment, materials, model), options, *model);
}

}  // namespace palpate::command
