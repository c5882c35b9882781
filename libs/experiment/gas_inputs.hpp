// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/experiment/actuation.hpp"

namespace palpate::experiment {

/// Column "<chamber>.air_m3" of actuation.csv: what was pumped into a closed chamber, as its volume
/// at ambient pressure, m3; 0 in one that was closed at rest; |value| <= 0.1 m3.
struct GasColumn {
  std::string chamber;
  std::vector<std::optional<double>> air_m3;  ///< one for each row, at least one present
  std::vector<SourceLocation> fields;         ///< of the rows
  SourceLocation where;                       ///< its header field
};

/// Inputs to compute a robot by. A recording has none of gas: there pressure or volume are
/// measured.
struct ActuationWithGas {
  Actuation actuation;
  std::vector<GasColumn> gas;

  /// Of the chamber, or nullptr where its amount of gas is not given.
  const GasColumn* FindGas(const std::string& chamber) const;
  /// m3 at this time, as Actuation::ValueAt.
  double AirAt_m3(const GasColumn& column, double now_s) const;
};

/// As ReadActuation, with columns of gas. Throws InputError with file:line:column.
ActuationWithGas ReadActuationWithGas(const std::filesystem::path& file);

/// Throws InputError at the header of a column that names no chamber of the robot ("did you mean"),
/// or one whose pressure or volume is given, too.
void CheckGas(const ActuationWithGas& inputs, const std::vector<std::string>& cables,
              const std::vector<std::string>& chambers);

}  // namespace palpate::experiment
