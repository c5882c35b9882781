// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/robot/gas_law.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::robot {

/// A closed chamber with a given amount of gas.
struct ChamberGas {
  int actuator = 0;     ///< a chamber, in the order of RobotModel::traits
  double air_m3 = 0.0;  ///< GasLaw
  double ambient_Pa = kAmbient_Pa;
};

struct GasSolveTuning {
  /// Of the volume against the law. Smaller: the static solver's own tolerance of 1e-10 m is
  /// reached first, where chambers are small. The pressure is better than this, as it converges
  /// quadratically.
  double relative_tolerance = 1e-7;
  int most_iterations = 40;
  /// Share of the way to a vacuum that the pressure may fall in one iteration: there the law has no
  /// volume any more.
  double most_fall = 0.9;
};

/// RobotModel::Solve with chambers of given gas, whose commands in `commands` do not count.
/// Newton's method on the law: each iteration solves with the law's tangent, the compliance of a
/// chamber whose volume is given, so that the pressures converge quadratically. Result and state
/// are those of the last iteration; iterations are added up. kInvalidInput, and the state stays:
/// what is no chamber, or loses more air than it holds. kTensionLimit names the chamber.
fem::StaticResult SolveWithGas(RobotModel& model, std::vector<ActuatorCommand> commands,
                               const std::vector<ChamberGas>& gas,
                               const std::vector<DeadLoad>& loads, fem::StaticState* state,
                               const GasSolveTuning& tuning = {});

}  // namespace palpate::robot
