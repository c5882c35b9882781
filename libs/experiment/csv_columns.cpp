// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/csv_columns.hpp"

#include <algorithm>
#include <array>

#include "libs/core/text.hpp"

namespace palpate::experiment {

namespace {

struct KnownUnit {
  std::string_view unit;
  std::string_view si;
  double factor;
};

constexpr std::array kUnits = {
    KnownUnit{"m", "m", 1.0},       KnownUnit{"mm", "m", 1e-3},
    KnownUnit{"cm", "m", 1e-2},     KnownUnit{"um", "m", 1e-6},
    KnownUnit{"km", "m", 1e3},      KnownUnit{"in", "m", 0.0254},
    KnownUnit{"inch", "m", 0.0254}, KnownUnit{"N", "N", 1.0},
    KnownUnit{"mN", "N", 1e-3},     KnownUnit{"kN", "N", 1e3},
    KnownUnit{"s", "s", 1.0},       KnownUnit{"ms", "s", 1e-3},
    KnownUnit{"us", "s", 1e-6},     KnownUnit{"ns", "s", 1e-9},
    KnownUnit{"Pa", "Pa", 1.0},     KnownUnit{"kPa", "Pa", 1e3},
    KnownUnit{"MPa", "Pa", 1e6},    KnownUnit{"mbar", "Pa", 100.0},
    KnownUnit{"bar", "Pa", 1e5},    KnownUnit{"psi", "Pa", 6894.757293168},
    KnownUnit{"m3", "m3", 1.0},     KnownUnit{"cm3", "m3", 1e-6},
    KnownUnit{"mm3", "m3", 1e-9},   KnownUnit{"ml", "m3", 1e-6},
    KnownUnit{"l", "m3", 1e-3},
};

std::string NameOfSi(const std::string& si) {
  if (si == "m") return "metres";
  if (si == "Pa") return "pascals";
  if (si == "m3") return "cubic metres";
  return si == "N" ? "newtons" : "seconds";
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

ColumnName SplitUnit(std::string_view column) {
  const std::size_t underscore = column.rfind('_');
  if (underscore == std::string_view::npos) return {std::string(column), ""};
  return {std::string(column.substr(0, underscore)), std::string(column.substr(underscore + 1))};
}

UnitFactor ToSi(std::string_view unit) {
  for (const KnownUnit& known : kUnits) {
    if (known.unit == unit) return {std::string(known.si), known.factor};
  }
  return {"", 1.0};
}

std::optional<std::size_t> ColumnFinder::Find(const std::string& name) const {
  const auto found = std::find(table_.header().begin(), table_.header().end(), name);
  if (found == table_.header().end()) return std::nullopt;
  return static_cast<std::size_t>(found - table_.header().begin());
}

std::size_t ColumnFinder::Require(const std::string& name) {
  known_.push_back(name);
  const std::optional<std::size_t> column = Find(name);
  if (column) return *column;
  RefuseOtherUnit(name);
  throw InputError(SourceLocation{table_.file(), 1, 1},
                   "column '" + name + "' is missing; the header has " + Joined(table_.header()));
}

std::optional<std::size_t> ColumnFinder::Optional(const std::string& name) {
  known_.push_back(name);
  const std::optional<std::size_t> column = Find(name);
  if (!column) RefuseOtherUnit(name);
  return column;
}

void ColumnFinder::RefuseOtherUnit(const std::string& name) const {
  const ColumnName wanted = SplitUnit(name);
  if (wanted.unit.empty()) return;
  for (std::size_t column = 0; column < table_.header().size(); ++column) {
    const ColumnName given = SplitUnit(table_.header()[column]);
    const bool same_quantity = ToSi(given.unit).si == ToSi(wanted.unit).si;
    if (given.stem == wanted.stem && same_quantity) RefuseUnit(table_, column, name);
  }
}

void ColumnFinder::Finish() const {
  for (std::size_t column = 0; column < table_.header().size(); ++column) {
    const std::string& name = table_.header()[column];
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    throw InputError(table_.HeaderWhere(column), "unknown column '" + name + "'" +
                                                     DidYouMean(name, known_) + "; known are " +
                                                     Joined(known_));
  }
}

void RefuseUnit(const CsvTable& table, std::size_t column, const std::string& expected) {
  const std::string si = ToSi(SplitUnit(expected).unit).si;
  throw InputError(table.HeaderWhere(column), "column '" + table.header()[column] +
                                                  "': " + NameOfSi(si) +
                                                  " are expected, as column '" + expected + "'");
}

double RisingTime(const CsvTable& table, std::size_t row, std::size_t column, Rise rise) {
  const double t_s = table.Number(row, column);
  if (row == 0) return t_s;
  const double before_s = table.Number(row - 1, column);
  if (t_s < before_s) {
    table.Refuse(row, column, "time must rise; the row above has " + FormatNumber(before_s));
  }
  if (rise == Rise::kStrict && t_s == before_s) {
    table.Refuse(row, column, "a second sample for this time");
  }
  return t_s;
}

}  // namespace palpate::experiment
