// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/recording_frames.hpp"

#include <optional>
#include <variant>

#include "libs/core/error.hpp"

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

std::optional<double> InputAt(const experiment::Recording& recording, const std::string& cable,
                              experiment::CableQuantity quantity, double t_s) {
  if (!recording.actuation) return std::nullopt;
  const experiment::CableColumn* column = recording.actuation->Find(cable, quantity);
  if (column == nullptr) return std::nullopt;
  return recording.actuation->ValueAt(*column, t_s);
}

}  // namespace

Eigen::Vector3d RotateSigma(const Eigen::Matrix3d& R_robot_measurement,
                            const Eigen::Vector3d& sigma_m) {
  const Eigen::Matrix3d covariance = R_robot_measurement * sigma_m.cwiseAbs2().asDiagonal() *
                                     R_robot_measurement.transpose();
  return covariance.diagonal().cwiseSqrt();
}

std::vector<MarkerFrame> FramesOfRecording(const experiment::Experiment& experiment,
                                           const experiment::Recording& recording,
                                           const robot::RobotModel& model,
                                           robot::CableInput preferred) {
  const std::vector<std::string> marker_names = model.MarkerNames();
  const std::vector<std::string> cable_names = model.CableNames();
  if (!recording.markers) {
    throw InputError(recording.folder.string() + ": the recording has no markers.csv");
  }
  experiment::CheckMarkers(recording, marker_names);
  experiment::CheckCables(recording, cable_names);
  const auto pose = experiment::RobotFromMarkers(experiment, recording);
  if (const auto* missing = std::get_if<experiment::NeedsCalibration>(&pose)) {
    throw InputError(recording.folder.string() + ": " + missing->reason);
  }
  const auto& T_robot_measurement = std::get<Eigen::Isometry3d>(pose);
  const Eigen::Vector3d sigma_m =
      RotateSigma(T_robot_measurement.linear(),
                  experiment.markers_sigma_m.value_or(Eigen::Vector3d::Zero()));
  std::vector<std::optional<size_t>> columns;
  for (const std::string& name : marker_names) columns.push_back(recording.markers->IndexOf(name));

  std::vector<MarkerFrame> frames;
  for (const experiment::MarkerFrame& measured : recording.markers->frames) {
    MarkerFrame frame;
    frame.t_s = measured.t_s;
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
    for (const std::string& cable : cable_names) {
      using Quantity = experiment::CableQuantity;
      frame.cables.push_back(robot::ChooseCommand(
          InputAt(recording, cable, Quantity::kDisplacement, measured.t_s),
          InputAt(recording, cable, Quantity::kTension, measured.t_s), preferred));
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace palpate::force_estimation
