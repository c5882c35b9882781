// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate::experiment {

/// What a column of actuation.csv holds.
enum class ActuatorQuantity {
  /// Of a cable m, pulled in from the undeformed mesh; |value| <= 2 m. Of a chamber m3, change of
  /// its volume from rest; |value| <= 0.1 m3.
  kDisplacement,
  /// Of a cable N, >= 0 (it cannot push). Of a chamber its pressure above ambient, Pa.
  kTension,
};

/// One column: the samples of one quantity of one actuator. At least one is present.
struct ActuatorColumn {
  std::string cable;  ///< its name; chambers have theirs from the same set
  ActuatorQuantity quantity = ActuatorQuantity::kDisplacement;
  std::vector<std::optional<double>> samples;  ///< one for each row; empty field: nullopt
  SourceLocation where;                        ///< its header field
  bool of_chamber = false;

  /// "<cable>.displacement_m", "<cable>.tension_N", "<chamber>.volume_m3" or
  /// "<chamber>.pressure_Pa".
  std::string Header() const;
};

/// actuation.csv: inputs of cables and chambers over time.
struct Actuation {
  std::vector<double> t_s;  ///< strictly rising, at least one
  std::vector<ActuatorColumn> columns;

  /// The column, or nullptr where the file has none.
  const ActuatorColumn* Find(const std::string& cable, ActuatorQuantity quantity) const;

  /// The input at time `t_s_now`: linear between the samples that are present; before the first
  /// of them the first, after the last the last. Unit of the column.
  double ValueAt(const ActuatorColumn& column, double t_s_now) const;
};

/// Reads actuation.csv. Throws InputError with file:line:column for an unknown, missing, doubled
/// or wrongly scaled column ("north.displacement_mm"), a wrong number of fields, what is no finite
/// number, time that does not rise, a negative tension, a pressure below vacuum. A column without a
/// sample is left out: its actuator was not driven.
Actuation ReadActuation(const std::filesystem::path& file);

/// Throws InputError at the header of a column that names no actuator of the robot, or a quantity
/// of the other kind ("did you mean").
void CheckActuators(const Actuation& actuation, const std::vector<std::string>& cables,
                    const std::vector<std::string>& chambers);

/// Writes what ReadActuation reads back exactly. Throws RunError where it cannot.
void WriteActuation(const Actuation& actuation, const std::filesystem::path& file);

}  // namespace palpate::experiment
