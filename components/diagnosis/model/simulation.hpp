// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::diagnosis {

/// One moment of a simulated experiment.
struct SimulatedSample {
  Status status;
  fem::StaticState state;
  std::vector<robot::CableCommand> commands;  ///< that hold the state
  Eigen::VectorXd elastic_N;                  ///< [3n] F_int without what the body remembers
  Eigen::Matrix3Xd markers_m;                 ///< [3 x markers] measurement frame
  Eigen::MatrixXd jacobian_m;                 ///< [3 markers x parameters] of them
};

/// A simulated experiment.
struct Simulation {
  Status status;  ///< of the first sample that failed
  std::vector<SimulatedSample> samples;
  /// [3n] elastic forces with every command at zero: what the body is between recordings.
  Eigen::VectorXd rest_elastic_N;
  Eigen::MatrixXd taken_in;  ///< [cables x samples] by the drives, m or N
};

}  // namespace palpate::diagnosis
