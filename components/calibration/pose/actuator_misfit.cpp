// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/actuator_misfit.hpp"

#include <cmath>
#include <limits>

#include "components/calibration/joint/model_snapshot.hpp"
#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

using Eigen::Index;
using Kind = robot::ActuatorCommand::Kind;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// [a] NaN: no equilibrium.
Eigen::VectorXd Displacements_m(robot::RobotModel& model, const CalibrationFrame& frame,
                                const std::vector<robot::ActuatorCommand>& cables) {
  const ModelSnapshot kept(model);
  Eigen::VectorXd displacement_m = Eigen::VectorXd::Constant(model.ActuatorCount(), kUnknown);
  model.SetGravity(frame.gravity_m_s2);
  fem::StaticState state = model.RestState();
  const bool solved = model.Solve(cables, frame.loads, &state).status.ok();
  kept.RestoreGravity();
  for (int c = 0; solved && c < model.ActuatorCount(); ++c) {
    displacement_m[c] = model.StateOfActuator(c, state).displacement_m;
  }
  return displacement_m;
}

/// Chi-squared of one cable over the frames, its offset marginalised.
double MisfitOf(const Eigen::RowVectorXd& off_m, bool has_offset, const ActuatorErrors& errors) {
  const double weight = 1.0 / (errors.displacement_m * errors.displacement_m);
  double count = 0.0, sum_m = 0.0, squares_m2 = 0.0;
  for (const double one_m : off_m) {
    if (!std::isfinite(one_m)) continue;
    count += 1.0;
    sum_m += one_m;
    squares_m2 += one_m * one_m;
  }
  if (!has_offset || errors.offset_m <= 0.0) return weight * squares_m2;
  const double information = weight * count + 1.0 / (errors.offset_m * errors.offset_m);
  return weight * squares_m2 - weight * weight * sum_m * sum_m / information;
}

}  // namespace

Eigen::MatrixXd CommandedDisplacements_m(robot::RobotModel& model,
                                         const std::vector<CalibrationFrame>& frames) {
  Eigen::MatrixXd commanded_m(model.ActuatorCount(), static_cast<Index>(frames.size()));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    auto column = commanded_m.col(static_cast<Index>(f));
    column = Displacements_m(model, frames[f], frames[f].cables);
    for (int c = 0; c < model.ActuatorCount(); ++c) {
      if (frames[f].cables[At(c)].kind == Kind::kNone) column[c] = kUnknown;
    }
  }
  return commanded_m;
}

double ActuatorMisfit(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                      const std::vector<Eigen::VectorXd>& tension_N,
                      const Eigen::MatrixXd& commanded_m, const ActuatorErrors& errors) {
  Eigen::MatrixXd off_m(commanded_m.rows(), commanded_m.cols());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<robot::ActuatorCommand> cables;
    for (const double one_N : tension_N[f]) cables.push_back({Kind::kTension, one_N});
    const auto column = static_cast<Index>(f);
    off_m.col(column) = Displacements_m(model, frames[f], cables) - commanded_m.col(column);
  }
  double misfit = 0.0;
  for (Index c = 0; c < off_m.rows(); ++c) {
    bool by_displacement = false;
    for (const CalibrationFrame& frame : frames) {
      by_displacement = by_displacement || frame.cables[At(c)].kind == Kind::kDisplacement;
    }
    misfit += MisfitOf(off_m.row(c), by_displacement, errors);
  }
  return misfit;
}

}  // namespace palpate::calibration
