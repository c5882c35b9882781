// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/recording_inputs.hpp"

#include <variant>

#include "libs/core/error.hpp"

namespace palpate::experiment {

const MarkerTracks& RequireMarkers(const Recording& recording) {
  if (!recording.markers) {
    throw InputError(recording.folder.string() + ": the recording has no markers.csv");
  }
  return *recording.markers;
}

Eigen::Isometry3d RequireRobotFromMarkers(const Experiment& experiment,
                                          const Recording& recording) {
  const auto pose = RobotFromMarkers(experiment, recording);
  if (const auto* missing = std::get_if<NeedsCalibration>(&pose)) {
    throw InputError(recording.folder.string() + ": " + missing->reason);
  }
  return std::get<Eigen::Isometry3d>(pose);
}

std::optional<double> ActuatorInputAt(const Recording& recording, const std::string& cable,
                                      ActuatorQuantity quantity, double t_s) {
  if (!recording.actuation) return std::nullopt;
  const ActuatorColumn* column = recording.actuation->Find(cable, quantity);
  if (column == nullptr) return std::nullopt;
  return recording.actuation->ValueAt(*column, t_s);
}

}  // namespace palpate::experiment
