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
enum class CableQuantity {
  kDisplacement,  ///< m, pulled in from the undeformed mesh; |value| <= 2 m
  kTension,       ///< N, >= 0 (a cable cannot push)
};

/// One column: the samples of one quantity of one cable. At least one is present.
struct CableColumn {
  std::string cable;
  CableQuantity quantity = CableQuantity::kDisplacement;
  std::vector<std::optional<double>> samples;  ///< one for each row; empty field: nullopt
  SourceLocation where;                        ///< its header field

  /// "<cable>.displacement_m" or "<cable>.tension_N".
  std::string Header() const;
};

/// actuation.csv: cable inputs over time.
struct Actuation {
  std::vector<double> t_s;  ///< strictly rising, at least one
  std::vector<CableColumn> columns;

  /// The column, or nullptr where the file has none.
  const CableColumn* Find(const std::string& cable, CableQuantity quantity) const;

  /// The input at time `t_s_now`: linear between the samples that are present; before the first
  /// of them the first, after the last the last. Unit of the column.
  double ValueAt(const CableColumn& column, double t_s_now) const;
};

/// Reads actuation.csv. Throws InputError with file:line:column for an unknown, missing, doubled
/// or wrongly scaled column ("north.displacement_mm"), a wrong number of fields, what is no finite
/// number, time that does not rise, a negative tension. A column without a sample is left out: its
/// cable was not driven.
Actuation ReadActuation(const std::filesystem::path& file);

/// Writes what ReadActuation reads back exactly. Throws RunError where it cannot.
void WriteActuation(const Actuation& actuation, const std::filesystem::path& file);

}  // namespace palpate::experiment
