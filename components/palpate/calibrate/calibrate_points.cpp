// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/calibrate_points.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/pose/unlabelled_recording.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/convergence_plot.hpp"
#include "components/palpate/calibrate/fit_markers.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

using calibration::UnlabelledCalibration;
using calibration::UnlabelledFrame;

void PrintAssignment(const UnlabelledCalibration& found, const PointsWithoutNames& points,
                     int marker_count) {
  for (std::size_t k = 0; k < found.frames.size(); ++k) {
    const std::size_t seen = points.frames[found.labels.frames[k]].points.size();
    const auto markers = static_cast<int>(found.frames[k].markers.size());
    fmt::print("{}: {} of {} markers seen, {} points are none; residual {:.3f} mm RMS\n",
               found.frames[k].name, markers, marker_count, static_cast<int>(seen) - markers,
               1e3 * found.joint.residual_rms_of_frame_m[k]);
  }
  if (found.choices > 1) {
    fmt::print(
        "the points alone allow {} assignments to markers; {} decides\n", found.choices,
        found.decided_by_last_pose ? "the earlier calibration's pose" : "the cable displacements");
  }
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} iterations\n",
             found.joint.chi_squared, found.joint.degrees_of_freedom, found.joint.iterations);
}

void Draw(const CalibrateOptions& options, const PointsWithoutNames& points,
          const UnlabelledCalibration& found, const robot::RobotModel& model) {
  std::vector<AssignmentPanel> panels;
  for (std::size_t k = 0; k < found.frames.size(); ++k) {
    const std::size_t f = found.labels.frames[k];
    AssignmentPanel& panel = panels.emplace_back();
    panel.name = found.frames[k].name;
    panel.points = points.frames[f].points;
    for (std::size_t p = 0; p < panel.points.size(); ++p) {
      panel.points[p].marker = found.labels.marker_of_point[k][p];
    }
    panel.model_m = MarkersInCamera(model, found.joint.x_m[k], found.joint.T_robot_camera);
    if (!points.grounds.empty()) panel.ground = points.grounds[f];
  }
  DrawAssignment(options.assignment, model.MarkerNames(), panels);
}

}  // namespace

robot::CalibrationFile CalibrateFromPoints(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment,
                                           const PointsWithoutNames& points,
                                           robot::RobotModel* model) {
  std::optional<geometry::RigidTransform> rough;
  if (const auto pose = RoughPose(options, experiment)) rough = ToTransform(*pose);
  calibration::UnlabelledSettings settings = points.settings;
  if (const auto pose = EarlierPose(options, *model)) {
    settings.T_robot_camera_last = ToTransform(*pose);
  }
  const UnlabelledCalibration found =
      calibration::CalibrateUnlabelled(*model, points.frames, rough ? &*rough : nullptr, settings);
  for (const std::string& line : found.left_out) fmt::print(stderr, "excluded: {}\n", line);
  RequireFit(found.status);
  RequirePossible(found.frames, found.joint, points.settings.request, model);
  if (!options.convergence.empty()) PlotConvergence(found.frames, model, options.convergence);
  if (!options.assignment.empty()) Draw(options, points, found, *model);
  robot::CalibrationFile file =
      calibration::MakeCalibration(*model, points.recordings, options.data);
  calibration::TakeFit(found.joint, *model, &file);
  if (!options.json) PrintAssignment(found, points, static_cast<int>(model->MarkerNames().size()));
  return file;
}

bool AreUnlabelled(const CalibrateOptions& options, const experiment::Experiment& experiment) {
  if (options.unlabelled) return true;
  bool any = false;
  for (const experiment::Recording& recording : experiment.recordings) {
    if (!recording.markers) continue;
    const auto& names = recording.markers->names;
    if (!std::all_of(names.begin(), names.end(), experiment::IsUnlabelled)) return false;
    any = true;
  }
  return any;
}

robot::CalibrationFile CalibrateFromUnlabelled(const CalibrateOptions& options,
                                               const experiment::Experiment& experiment,
                                               const std::vector<int>& materials,
                                               robot::RobotModel* model) {
  if (!HasMarkersOfTheCamera(experiment)) {
    throw InputError(
        "points without names are assigned to markers only in a camera's frame (frame: camera) of "
        "unknown pose; markers in the robot's frame need names in markers.csv");
  }
  PointsWithoutNames points;
  points.recordings = ChosenRecordings(options, experiment, true);
  for (const experiment::Recording* recording : points.recordings) {
    RequireLoads(*recording);
    for (UnlabelledFrame& frame : calibration::UnlabelledFramesOfRecording(
             experiment, *recording, *model, ParseCableInput(options.cable_input),
             options.marker_bias_m)) {
      points.frames.push_back(std::move(frame));
    }
  }
  points.settings.request = RequestOf(options, experiment, materials, true);
  return CalibrateFromPoints(options, experiment, points, model);
}

}  // namespace palpate::command
