// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/tension_range.hpp"

#include <algorithm>
#include <cmath>

#include "components/calibration/joint/model_snapshot.hpp"
#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

using Kind = robot::ActuatorCommand::Kind;

/// A wider range holds more offsets, and leaves the polynomial of MarkerShapes larger errors.
struct TensionRangeTuning {
  double margin = 1.2;         ///< factor on the tensions of the inputs
  double offset_sigmas = 2.0;  ///< of actuators, added to displacements
  double far_share = 0.25;     ///< motion of a marker over the spread, for a cable without an input
  int doublings = 12;          ///< of the tension, up to max_tension_N
  double least_share = 0.05;   ///< of the range of a cable alone, for a slack cable
};
constexpr TensionRangeTuning kRangeTuning;

Eigen::Matrix3Xd MarkersAt(const robot::RobotModel& model, const fem::StaticState& state) {
  const auto& markers = model.body().markers;
  Eigen::Matrix3Xd markers_m(3, ToIndex(markers.size()));
  for (std::size_t m = 0; m < markers.size(); ++m) {
    markers_m.col(ToIndex(m)) = markers[m].point.weights.Position(state.x_m);
  }
  return markers_m;
}

/// Tension of one cable alone up to which no marker moves far.
double ReachOf(robot::RobotModel& model, int cable) {
  const double most_N = model.traits(cable).most_force_N;
  fem::StaticState state = model.RestState();
  const Eigen::Matrix3Xd rest_m = MarkersAt(model, state);
  const Eigen::Vector3d middle_m = rest_m.rowwise().mean();
  const double spread_m = std::sqrt((rest_m.colwise() - middle_m).colwise().squaredNorm().mean());
  double reach_N = std::ldexp(most_N, -kRangeTuning.doublings);
  for (double tension_N = reach_N; tension_N <= most_N; tension_N *= 2.0) {
    std::vector<robot::ActuatorCommand> commands(static_cast<std::size_t>(model.ActuatorCount()));
    commands[At(cable)] = {Kind::kTension, tension_N};
    if (!model.Solve(commands, {}, &state).status.ok()) break;
    const Eigen::Matrix3Xd moved_m = MarkersAt(model, state) - rest_m;
    if (moved_m.colwise().norm().maxCoeff() > kRangeTuning.far_share * spread_m) break;
    reach_N = tension_N;
  }
  return reach_N;
}

/// Raises `most_N` to the tensions of one frame.
Status Raise(robot::RobotModel& model, const CalibrationFrame& frame,
             double actuator_offset_sigma_m, Eigen::VectorXd* most_N) {
  std::vector<robot::ActuatorCommand> commands = frame.cables;
  for (robot::ActuatorCommand& command : commands) {
    if (command.kind == Kind::kDisplacement)
      command.value += kRangeTuning.offset_sigmas * actuator_offset_sigma_m;
  }
  model.SetGravity(frame.gravity_m_s2);
  fem::StaticState state = model.RestState();
  const fem::StaticResult result = model.Solve(commands, frame.loads, &state);
  if (!result.status.ok()) {
    return {result.status.code(), frame.name + ": " + result.status.message()};
  }
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    const double tension_N = model.StateOfActuator(c, state).tension_N;
    (*most_N)[c] = std::max((*most_N)[c], kRangeTuning.margin * tension_N);
  }
  return Status::Ok();
}

}  // namespace

Status FindTensionRange(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                        double actuator_offset_sigma_m, Eigen::VectorXd* most_N) {
  const ModelSnapshot kept(model);
  *most_N = Eigen::VectorXd::Zero(model.ActuatorCount());
  Status status = Status::Ok();
  for (const CalibrationFrame& frame : frames) {
    if (status.ok()) status = Raise(model, frame, actuator_offset_sigma_m, most_N);
  }
  kept.RestoreGravity();
  if (!status.ok()) return status;
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    const auto is_unknown = [&](const CalibrationFrame& frame) {
      return frame.cables[At(c)].kind == Kind::kNone;
    };
    const bool unknown = std::any_of(frames.begin(), frames.end(), is_unknown);
    if (!unknown && (*most_N)[c] > 0.0) continue;
    const double share = unknown ? 1.0 : kRangeTuning.least_share;
    (*most_N)[c] = std::max((*most_N)[c], share * ReachOf(model, c));
  }
  return status;
}

}  // namespace palpate::calibration
