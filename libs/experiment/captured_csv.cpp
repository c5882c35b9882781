// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "libs/experiment/capture/wide_markers.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"

namespace palpate::experiment {

namespace {

struct LengthColumn {
  std::size_t index = 0;
  double metres_per_unit = 1.0;
};

// The column "<stem>_m", "<stem>_cm" or "<stem>_mm", asked for by the name that the file gives it.
std::optional<LengthColumn> FindLength(const CsvTable& table, const std::string& stem,
                                       ColumnFinder& finder) {
  for (const std::string unit : {"m", "cm", "mm"}) {
    const std::string name = stem + "_" + unit;
    const auto& header = table.header();
    if (std::find(header.begin(), header.end(), name) == header.end()) continue;
    return LengthColumn{finder.Require(name), ToSi(unit).factor};
  }
  return std::nullopt;
}

LengthColumn RequireLength(const CsvTable& table, const std::string& stem, ColumnFinder& finder) {
  if (const auto column = FindLength(table, stem, finder)) return *column;
  return {finder.Require(stem + "_m"), 1.0};
}

MarkerColumns FindColumns(const CsvTable& table) {
  ColumnFinder finder(table);
  MarkerColumns columns;
  const auto& header = table.header();
  const bool long_name = std::find(header.begin(), header.end(), "time_s") != header.end();
  columns.time = finder.Require(long_name ? "time_s" : "t_s");
  columns.marker = finder.Require("marker");
  std::size_t axis = 0;
  for (const std::string stem : {"x", "y", "z"}) {
    const LengthColumn column = RequireLength(table, stem, finder);
    columns.position[axis] = column.index;
    columns.metres_per_unit[axis] = column.metres_per_unit;
    ++axis;
  }
  if (const auto column = FindLength(table, "residual", finder)) {
    columns.residual = column->index;
    columns.residual_metres_per_unit = column->metres_per_unit;
  }
  finder.Finish();
  return columns;
}

}  // namespace

CapturedMarkers ReadCapturedCsv(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Read(file);
  MarkerTable markers = ReadMarkerTable(table, FindColumns(table));
  CapturedMarkers captured;
  captured.rate_Hz = MedianRate(markers.tracks.frames);
  captured.tracks = std::move(markers.tracks);
  captured.residuals_m = std::move(markers.residuals_m);
  return captured;
}

}  // namespace palpate::experiment
