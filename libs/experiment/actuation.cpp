// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/actuation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"

namespace palpate::experiment {

namespace {

constexpr double kLargestDisplacement_m = 2.0;
constexpr const char* kDisplacementSuffix = ".displacement_m";
constexpr const char* kTensionSuffix = ".tension_N";

// Cable and quantity of a header field; throws where it names neither quantity or another unit.
CableColumn ParseHeaderField(const CsvTable& table, std::size_t index) {
  const std::string& name = table.header()[index];
  const std::size_t dot = name.rfind('.');
  CableColumn column;
  column.where = table.HeaderWhere(index);
  if (dot == 0 || dot == std::string::npos) {
    throw InputError(column.where, "unknown column '" + name +
                                       "'; expected t_s, <cable>.displacement_m or "
                                       "<cable>.tension_N");
  }
  column.cable = name.substr(0, dot);
  const std::string suffix = name.substr(dot);
  if (suffix == kDisplacementSuffix) return column;
  column.quantity = CableQuantity::kTension;
  if (suffix == kTensionSuffix) return column;

  const ColumnName quantity = SplitUnit(suffix);
  if (quantity.stem == ".displacement") {
    RefuseUnit(table, index, column.cable + kDisplacementSuffix);
  }
  if (quantity.stem == ".tension") RefuseUnit(table, index, column.cable + kTensionSuffix);
  throw InputError(column.where, "unknown column '" + name + "'" +
                                     DidYouMean(name, {column.cable + kDisplacementSuffix,
                                                       column.cable + kTensionSuffix}) +
                                     "; expected <cable>.displacement_m or <cable>.tension_N");
}

void CheckSample(const CsvTable& table, std::size_t row, std::size_t index, CableQuantity quantity,
                 double value) {
  if (quantity == CableQuantity::kTension && value < 0.0) {
    table.Refuse(row, index, "a tension is never negative (a cable cannot push)");
  }
  if (quantity == CableQuantity::kDisplacement && std::abs(value) > kLargestDisplacement_m) {
    table.Refuse(row, index,
                 "more than " + FormatNumber(kLargestDisplacement_m) +
                     " m; metres are expected, are these millimetres?");
  }
}

/// nullopt where every field is empty: it was not measured.
std::optional<CableColumn> ReadColumn(const CsvTable& table, std::size_t index) {
  CableColumn column = ParseHeaderField(table, index);
  column.samples.reserve(table.rows());
  bool any = false;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    column.samples.push_back(table.OptionalNumber(row, index));
    if (!column.samples.back()) continue;
    CheckSample(table, row, index, column.quantity, *column.samples.back());
    any = true;
  }
  if (!any) return std::nullopt;
  return column;
}

}  // namespace

std::string CableColumn::Header() const {
  return cable + (quantity == CableQuantity::kDisplacement ? kDisplacementSuffix : kTensionSuffix);
}

const CableColumn* Actuation::Find(const std::string& cable, CableQuantity quantity) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const CableColumn& column) {
    return column.cable == cable && column.quantity == quantity;
  });
  return found == columns.end() ? nullptr : &*found;
}

double Actuation::ValueAt(const CableColumn& column, double t_s_now) const {
  PALPATE_CHECK(column.samples.size() == t_s.size(), column.samples.size(), t_s.size());
  const auto upper = std::upper_bound(t_s.begin(), t_s.end(), t_s_now);
  const auto split = static_cast<std::size_t>(upper - t_s.begin());
  std::size_t before = split;
  while (before > 0 && !column.samples[before - 1]) --before;
  std::size_t after = split;
  while (after < t_s.size() && !column.samples[after]) ++after;
  PALPATE_CHECK(before > 0 || after < t_s.size(), column.Header(), "has no sample");
  if (before == 0) return *column.samples[after];
  if (after == t_s.size()) return *column.samples[before - 1];
  const double fraction = (t_s_now - t_s[before - 1]) / (t_s[after] - t_s[before - 1]);
  return std::lerp(*column.samples[before - 1], *column.samples[after], fraction);
}

Actuation ReadActuation(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Read(file);
  const auto& header = table.header();
  const auto time = std::find(header.begin(), header.end(), "t_s");
  if (time == header.end()) ColumnFinder(table).Require("t_s");
  const auto time_index = static_cast<std::size_t>(time - header.begin());
  if (table.rows() == 0) throw InputError(SourceLocation{table.file(), 2, 1}, "no row of samples");
  if (header.size() == 1) throw InputError(table.HeaderWhere(0), "no column for a cable");

  Actuation actuation;
  actuation.t_s.reserve(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    actuation.t_s.push_back(RisingTime(table, row, time_index, Rise::kStrict));
  }
  for (std::size_t index = 0; index < header.size(); ++index) {
    if (index == time_index) continue;
    if (auto column = ReadColumn(table, index)) actuation.columns.push_back(std::move(*column));
  }
  return actuation;
}

void WriteActuation(const Actuation& actuation, const std::filesystem::path& file) {
  std::string text = "t_s";
  for (const CableColumn& column : actuation.columns) text += "," + column.Header();
  text += '\n';
  for (std::size_t row = 0; row < actuation.t_s.size(); ++row) {
    text += FormatNumber(actuation.t_s[row]);
    for (const CableColumn& column : actuation.columns) {
      text += ',';
      if (column.samples[row]) text += FormatNumber(*column.samples[row]);
    }
    text += '\n';
  }
  WriteFile(file, text);
}

}  // namespace palpate::experiment
