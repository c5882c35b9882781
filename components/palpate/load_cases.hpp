// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/experiment/gas_inputs.hpp"
#include "libs/experiment/loads.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/solve_with_gas.hpp"

namespace palpate::command {

/// One static state to compute.
struct LoadCase {
  double t_s = 0.0;
  std::vector<robot::ActuatorCommand> cables;  ///< in the order of the robot's actuators
  std::vector<robot::ChamberGas> gas;          ///< of closed chambers; then `cables` has no command
  std::vector<experiment::KnownLoad> loads;
};

struct LoadCases {
  std::vector<LoadCase> rows;
  std::vector<std::string> notes;  ///< actuators that are not driven, or that have two columns
};

/// Reads actuation.csv; here it may also hold times alone (no cable is actuated).
/// Throws InputError as experiment::ReadActuationWithGas does.
experiment::ActuationWithGas ReadActuationRows(const std::filesystem::path& file);

/// One case for each row of `actuation`; without it one for each time of `loads`; without either
/// one under gravity alone. A cable without a column is not actuated, a chamber is open to the air;
/// of one with two columns the `preferred` is prescribed (of a chamber its volume is its
/// displacement); an empty field is interpolated in time within its column. Throws InputError at
/// the header for an actuator that the robot does not have (with "did you mean"), and for a chamber
/// of given gas whose pressure or volume is given, too.
LoadCases MakeLoadCases(const std::optional<experiment::ActuationWithGas>& actuation,
                        const std::vector<experiment::KnownLoad>& loads,
                        const std::vector<robot::ActuatorTraits>& actuators,
                        robot::CableInput preferred);

/// Throws InputError at the first field by which a chamber loses all the air that it and its tube
/// hold at rest, or more.
void CheckAir(const experiment::ActuationWithGas& actuation,
              const std::vector<robot::BodyChamber>& chambers);

}  // namespace palpate::command
