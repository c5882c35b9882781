// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/experiment/experiment.hpp"
#include "libs/robot/actuator.hpp"

namespace palpate::diagnosis {

/// What the actuators were commanded through a whole experiment, rests between recordings included:
/// faults that have a memory (play, friction, creep, lag) run through it. Piecewise linear in time.
struct Timeline {
  std::vector<robot::ActuatorTraits> actuators;  ///< of the robot: cables, then chambers
  /// [actuators] command is a tension, or the thrust of a chamber's pressure, N; else m
  std::vector<bool> by_tension;
  std::vector<double> t_s;               ///< strictly rising
  std::vector<Eigen::VectorXd> command;  ///< [times][actuators]; NaN: not driven
  std::vector<double> begin_s, end_s;    ///< [recordings] of what was recorded of each

  Eigen::VectorXd CommandAt(double t_s) const;
};

/// Displacement where a cable has both columns, pressure where a chamber has. Chambers count as
/// their pistons. Between recordings the commands go straight to zero
/// in the first half of rest_between_s and stay there; where the stamps leave no room for a rest,
/// the next recording begins as they say. Times are those of the experiment's clock.
Timeline ReadTimeline(const experiment::Experiment& experiment,
                      const std::vector<robot::ActuatorTraits>& actuators);

}  // namespace palpate::diagnosis
