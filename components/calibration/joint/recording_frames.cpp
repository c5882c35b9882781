// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/recording_frames.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "components/calibration/recording_phase.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::calibration {

namespace {

using experiment::TimeWindow;

std::vector<MarkerSighting> Sightings(const experiment::Experiment& experiment,
                                      const experiment::Recording& recording,
                                      const robot::RobotModel& model, const TimeWindow& window,
                                      double marker_bias_m) {
  const std::vector<experiment::MarkerMean> means =
      experiment::MeanOver(*recording.markers, window);
  const Eigen::Vector3d sigma_m = experiment.markers_sigma_m.value_or(Eigen::Vector3d::Zero());
  // Rounding of the file bounds the accuracy of a mean.
  constexpr double kFloor_m2 = 1e-14;
  std::vector<MarkerSighting> sightings;
  const std::vector<std::string> names = model.MarkerNames();
  for (std::size_t m = 0; m < names.size(); ++m) {
    const std::optional<std::size_t> column = recording.markers->IndexOf(names[m]);
    if (!column || means[*column].count == 0) continue;
    const experiment::MarkerMean& mean = means[*column];
    const Eigen::Vector3d noise_m =
        mean.count > 2 ? mean.deviation_m.cwiseMax(sigma_m).eval() : sigma_m;
    const Eigen::Vector3d variance_m2 =
        (noise_m.cwiseAbs2() / mean.count).array() + marker_bias_m * marker_bias_m + kFloor_m2;
    sightings.push_back({.marker = static_cast<int>(m),
                         .position_m = mean.mean_m,
                         .covariance_m2 = variance_m2.asDiagonal()});
  }
  return sightings;
}

/// The reference window as a frame.
CalibrationFrame ReferenceFrame(const experiment::Experiment& experiment,
                                const experiment::Recording& recording,
                                const robot::RobotModel& model, robot::CableInput preferred) {
  const experiment::Reference& reference = *recording.reference;
  CalibrationFrame frame{
      .name = recording.name + " (reference)",
      .markers = Sightings(experiment, recording, model, reference.window_s, 0.0)};
  if (reference.shape == experiment::ReferenceShape::kUndeformed) {
    const auto cables = static_cast<std::size_t>(model.CableCount());
    frame.cables.assign(cables, {robot::ActuatorCommand::Kind::kTension, 0.0});
    frame.cables.resize(static_cast<std::size_t>(model.ActuatorCount()));  // open to the air
    return frame;
  }
  const double middle_s = 0.5 * (reference.window_s.begin_s + reference.window_s.end_s);
  frame.cables = CablesAt(recording, model, preferred, middle_s);
  frame.gravity_m_s2 = experiment::BaseRotation(recording).transpose() * model.gravity_m_s2();
  return frame;
}

}  // namespace

std::vector<CalibrationFrame> FramesOfRecording(const experiment::Experiment& experiment,
                                                const experiment::Recording& recording,
                                                const robot::RobotModel& model,
                                                robot::CableInput preferred, double marker_bias_m,
                                                int most_frames) {
  experiment::RequireMarkers(recording);
  experiment::CheckMarkers(recording, model.MarkerNames());
  experiment::CheckActuators(recording, model.CableNames(), model.ChamberNames());
  const std::vector<TimeWindow> windows = WindowsOf(recording, most_frames);
  std::vector<CalibrationFrame> frames;
  for (const TimeWindow& window : windows) {
    const double middle_s = 0.5 * (window.begin_s + window.end_s);
    CalibrationFrame frame{
        .name = windows.size() == 1 ? recording.name
                                    : recording.name + " at " + FormatNumber(middle_s) + " s",
        .markers = Sightings(experiment, recording, model, window, marker_bias_m),
        .cables = CablesAt(recording, model, preferred, middle_s),
        .loads = LoadsAt(recording, model, middle_s),
        .load_places = LoadPlacesAt(recording, middle_s),
        .gravity_m_s2 = experiment::BaseRotation(recording).transpose() * model.gravity_m_s2()};
    if (!frame.markers.empty()) frames.push_back(std::move(frame));
  }
  if (frames.empty()) {
    throw InputError(recording.folder.string() + ": no marker of the robot was seen");
  }
  return frames;
}

/// The pose of a recording that is not seen from the camera to calibrate. Recordings of one pose
/// share its error.
int RecordedFrames::OwnPoseOf(const experiment::Recording& recording) {
  const bool robot =
      experiment::FrameOf(experiment_, recording) == experiment::MeasurementFrame::kRobot;
  const Eigen::Isometry3d T = experiment::RequireRobotFromMarkers(experiment_, recording);
  const geometry::PoseStandardError error =
      robot ? geometry::PoseStandardError{} : experiment::PoseErrorOf(experiment_, recording);
  const PosePrior pose{
      .name = robot ? "frame: robot"
                    : "T_robot_camera of " +
                          (recording.T_robot_camera ? recording.name : "experiment.yaml"),
      .T_robot_camera = {Eigen::Quaterniond(T.linear()), T.translation()},
      .translation_sigma_m = error.translation_m,
      .rotation_sigma_rad = error.rotation_rad};
  const auto same = [&](const PosePrior& other) {
    return ChangeBetween(other.T_robot_camera, pose.T_robot_camera).isZero(1e-12) &&
           other.translation_sigma_m == pose.translation_sigma_m &&
           other.rotation_sigma_rad == pose.rotation_sigma_rad;
  };
  const auto found = std::find_if(own_poses_.begin(), own_poses_.end(), same);
  if (found != own_poses_.end()) return static_cast<int>(found - own_poses_.begin());
  own_poses_.push_back(pose);
  return static_cast<int>(own_poses_.size()) - 1;
}

void RecordedFrames::Add(const experiment::Recording& recording, bool of_camera) {
  std::vector<CalibrationFrame> frames =
      FramesOfRecording(experiment_, recording, model_, preferred_, marker_bias_m_);
  if (recording.reference) {
    frames.push_back(ReferenceFrame(experiment_, recording, model_, preferred_));
    has_reference_ = true;
  }
  const int own_pose = of_camera ? -1 : OwnPoseOf(recording);
  has_camera_ = has_camera_ || of_camera;
  for (CalibrationFrame& frame : frames) {
    frame.own_pose = own_pose;
    frames_.push_back(std::move(frame));
  }
}

bool IsOfTheCamera(const experiment::Experiment& experiment,
                   const experiment::Recording& recording) {
  return recording.markers && !recording.T_robot_camera &&
         experiment::FrameOf(experiment, recording) == experiment::MeasurementFrame::kCamera &&
         recording.kind != experiment::RecordingKind::kCameraMoved &&
         (recording.camera_on_base || !recording.base_tilt_deg);
}

double OffsetOfMarkers_m(const robot::RobotModel& model) {
  constexpr double kShareOfExtent = 0.02;
  const Eigen::Matrix3Xd& nodes_m = model.body().mesh.nodes_m;
  return kShareOfExtent * (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).maxCoeff();
}

}  // namespace palpate::calibration
