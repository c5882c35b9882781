// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import/import_capture.hpp"

#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/experiment/capture_edit.hpp"

namespace palpate::command {

using experiment::CapturedMarkers;
using experiment::MeasurementFrame;
using experiment::TimeWindow;

namespace {

CapturedMarkers ReadFile(const ImportOptions& options) {
  experiment::C3dOptions c3d_options;
  if (!options.unit.empty()) c3d_options.unit_if_absent = options.unit;
  return experiment::ReadCapture(options.file, c3d_options);
}

std::optional<TimeWindow> Shifted(std::optional<TimeWindow> window, double offset_s) {
  if (window) *window = {window->begin_s + offset_s, window->end_s + offset_s};
  return window;
}

MeasurementFrame ChooseFrame(const ImportOptions& options) {
  const bool has_pose = !options.pose.empty() || options.register_to_robot;
  const bool is_robot_frame = !options.axes.empty() && !has_pose;
  if (options.frame.empty()) {
    return is_robot_frame ? MeasurementFrame::kRobot : MeasurementFrame::kCamera;
  }
  const MeasurementFrame frame = experiment::ParseMeasurementFrame(options.frame, {"--frame"});
  if (frame == MeasurementFrame::kRobot && has_pose) {
    throw InputError("--frame robot has no camera pose: leave out --pose and --register");
  }
  return frame;
}

void CheckWindow(const std::string& option, const std::optional<TimeWindow>& window,
                 const experiment::MarkerTracks& tracks) {
  if (!window) return;
  const bool any = std::any_of(tracks.frames.begin(), tracks.frames.end(),
                               [&](const auto& frame) { return window->Contains(frame.t_s); });
  if (!any) throw InputError("--" + option + ": no frame lies inside the window");
}

void CheckWindows(const experiment::Recording& recording) {
  if (recording.reference) {
    CheckWindow("rest-window", recording.reference->window_s, *recording.markers);
  }
  CheckWindow("steady-window", recording.steady_window_s, *recording.markers);
}

}  // namespace

CapturedMarkers ReadAndEdit(const ImportOptions& options) {
  CapturedMarkers captured = ReadFile(options);
  const auto new_names = ParseRenames(options.rename);
  experiment::RenameMarkers(new_names, captured);
  if (!options.markers.empty()) {
    std::vector<std::string> kept = SplitNames(options.markers, ',');
    for (std::string& name : kept) {
      if (const auto renamed = new_names.find(name); renamed != new_names.end()) {
        name = renamed->second;
      }
    }
    experiment::KeepMarkers(kept, captured);
  }
  if (!options.axes.empty()) experiment::Rotate(experiment::ParseAxes(options.axes), captured);
  experiment::CropTime({options.from_s, options.to_s}, captured);
  if (options.rate_Hz != 0.0) experiment::ThinFrames(options.rate_Hz, captured);
  experiment::ShiftTime(options.time_offset_s, captured);
  return captured;
}

experiment::Recording MakeRecording(const ImportOptions& options, const CapturedMarkers& captured) {
  experiment::Recording recording;
  recording.name = options.recording;
  recording.kind = experiment::ParseRecordingKind(options.kind, {"--kind"});
  recording.notes = options.notes;
  recording.markers = captured.tracks;
  recording.T_robot_camera = ParsePose(options.pose);
  recording.steady_window_s =
      Shifted(ParseWindow("steady-window", options.steady_window), options.time_offset_s);
  const auto rest = Shifted(ParseWindow("rest-window", options.rest_window), options.time_offset_s);
  if (rest) {
    // Nothing but hands or zero gravity keeps a soft body straight. Without gravity and cables the
    // two shapes are equal.
    const bool undeformed = options.rest_shape == "undeformed";
    recording.reference = {*rest, undeformed ? experiment::ReferenceShape::kUndeformed
                                             : experiment::ReferenceShape::kEquilibrium};
  }
  recording.loads = ParseLoads(options.loads, recording.markers->frames.front().t_s);
  recording.frame = ChooseFrame(options);
  CheckWindows(recording);
  return recording;
}

}  // namespace palpate::command
