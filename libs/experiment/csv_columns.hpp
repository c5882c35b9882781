// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/experiment/csv_table.hpp"

namespace palpate::experiment {

/// "x_mm" -> stem "x", unit "mm"; without an underscore the unit is empty.
struct ColumnName {
  std::string stem;
  std::string unit;
};
ColumnName SplitUnit(std::string_view column);

/// SI unit of the quantity that `unit` belongs to ("mm" -> "m", "mN" -> "N", "ms" -> "s"), and the
/// factor to it; an empty `si` where the unit is not known.
struct UnitFactor {
  std::string si;
  double factor = 1.0;
};
UnitFactor ToSi(std::string_view unit);

/// Indices of the columns of a table, found by exact name: Require/Optional name them, Finish()
/// refuses the rest with "did you mean", or, for a known name in another unit, with the unit that
/// is expected. Any order of columns will do.
class ColumnFinder {
 public:
  explicit ColumnFinder(const CsvTable& table) : table_(table) {}

  /// Throws InputError where the column is missing.
  std::size_t Require(const std::string& name);
  std::optional<std::size_t> Optional(const std::string& name);
  /// Throws InputError at the first unknown column.
  void Finish() const;

 private:
  std::optional<std::size_t> Find(const std::string& name) const;
  void RefuseOtherUnit(const std::string& name) const;

  const CsvTable& table_;
  std::vector<std::string> known_;
};

/// Throws InputError at the header of `column`, which is in a unit that this format does not use.
[[noreturn]] void RefuseUnit(const CsvTable& table, std::size_t column,
                             const std::string& expected);

enum class Rise { kStrict, kOrEqual };

/// The time in (row, column), s; throws InputError where it does not rise from the row above.
double RisingTime(const CsvTable& table, std::size_t row, std::size_t column, Rise rise);

}  // namespace palpate::experiment
