// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/recording_frames.hpp"

#include <optional>

#include "libs/core/index.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::force_estimation {

namespace {

ReferenceShape ReferenceAt(const experiment::Recording& recording, double t_s) {
  if (!recording.reference || !recording.reference->window_s.Contains(t_s)) {
    return ReferenceShape::kNone;
  }
  return recording.reference->shape == experiment::ReferenceShape::kUndeformed
             ? ReferenceShape::kUndeformed
             : ReferenceShape::kEquilibrium;
}

}  // namespace

Eigen::Vector3d RotateSigma(const Eigen::Matrix3d& R_robot_measurement,
                            const Eigen::Vector3d& sigma_m) {
  const Eigen::Matrix3d covariance =
      R_robot_measurement * sigma_m.cwiseAbs2().asDiagonal() * R_robot_measurement.transpose();
  return covariance.diagonal().cwiseSqrt();
}

std::vector<robot::ActuatorCommand> CablesAt(const experiment::Recording& recording,
                                             const robot::RobotModel& model,
                                             robot::CableInput preferred, double t_s) {
  using Quantity = experiment::ActuatorQuantity;
  std::vector<robot::ActuatorCommand> commands;
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    const std::string& name = model.traits(c).name;
    commands.push_back(model.CommandFor(
        c, experiment::ActuatorInputAt(recording, name, Quantity::kDisplacement, t_s),
        experiment::ActuatorInputAt(recording, name, Quantity::kTension, t_s), preferred));
  }
  return commands;
}

std::vector<MarkerFrame> FramesOfRecording(const experiment::Experiment& experiment,
                                           const experiment::Recording& recording,
                                           const robot::RobotModel& model,
                                           robot::CableInput preferred) {
  const std::vector<std::string> marker_names = model.MarkerNames();
  const experiment::MarkerTracks& tracks = experiment::RequireMarkers(recording);
  experiment::CheckMarkers(recording, marker_names);
  experiment::CheckActuators(recording, model.CableNames(), model.ChamberNames());
  const Eigen::Isometry3d T_robot_measurement =
      experiment::RequireRobotFromMarkers(experiment, recording);
  const Eigen::Vector3d sigma_m = RotateSigma(
      T_robot_measurement.linear(), experiment.markers_sigma_m.value_or(Eigen::Vector3d::Zero()));
  const PoseError pose_error = StatedPoseError(experiment, recording);
  std::vector<std::optional<size_t>> columns;
  for (const std::string& name : marker_names) columns.push_back(tracks.IndexOf(name));

  std::vector<MarkerFrame> frames;
  for (const experiment::MarkerFrame& measured : tracks.frames) {
    MarkerFrame frame;
    frame.t_s = measured.t_s;
    frame.pose_error = pose_error;
    frame.reference = ReferenceAt(recording, measured.t_s);
    for (const std::optional<size_t>& column : columns) {
      MarkerObservation marker;
      if (column && measured.positions_m[*column]) {
        marker.valid = true;
        marker.position_m = T_robot_measurement * *measured.positions_m[*column];
        marker.sigma_m = sigma_m;
      }
      frame.markers.push_back(marker);
    }
    frame.cables = CablesAt(recording, model, preferred, measured.t_s);
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace palpate::force_estimation
