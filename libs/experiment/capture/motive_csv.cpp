// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <map>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/capture/exports.hpp"
#include "libs/experiment/capture/wide_markers.hpp"

namespace palpate::experiment {

namespace {

using Row = std::vector<std::string>;

/// The lines before the frames.
struct MotiveHeader {
  std::map<std::string, std::string> settings;  ///< first line: name, value, name, value, ...
  std::map<std::string, Row> rows;              ///< "type", "name", ... by their second cell
  Row quantities;                               ///< Rotation, Position, ... of each column
  Row axes;                                     ///< X, Y, Z, W, or empty, of each column

  std::string Setting(const std::string& name) const {
    const auto setting = settings.find(name);
    return setting == settings.end() ? "" : setting->second;
  }
  std::string Cell(const std::string& row, std::size_t column) const {
    const auto found = rows.find(row);
    return found == rows.end() || column >= found->second.size() ? "" : found->second[column];
  }
  bool IsPosition(std::size_t column) const {
    return column < quantities.size() && column + 2 < axes.size() &&
           LowerCase(quantities[column]) == "position" && axes[column] == "X" &&
           axes[column + 1] == "Y" && axes[column + 2] == "Z";
  }
};

MotiveHeader ReadMotiveHeader(CaptureText& text) {
  MotiveHeader header;
  text.NextLine();
  for (std::size_t i = 0; i + 1 < text.cells().size(); i += 2) {
    header.settings.emplace(LowerCase(text.Cell(i)), text.Cell(i + 1));
  }
  while (text.NextLine()) {
    const Row cells(text.cells().begin(), text.cells().end());
    if (LowerCase(text.Cell(0)) == "frame") {
      header.axes = cells;
      return header;
    }
    if (text.IsBlank()) continue;
    if (text.Cell(1).empty()) {
      header.quantities = cells;
    } else {
      header.rows[LowerCase(text.Cell(1))] = cells;
    }
  }
  throw InputError(SourceLocation{text.file()},
                   "is a CSV file of Motive without a line 'Frame,Time (Seconds),...'");
}

/// Columns of the positions of one type.
std::vector<std::size_t> PositionsOf(const MotiveHeader& header, const std::string& type) {
  std::vector<std::size_t> columns;
  for (std::size_t column = 2; column < header.axes.size(); ++column) {
    if (header.IsPosition(column) && LowerCase(header.Cell("type", column)) == type) {
      columns.push_back(column);
    }
  }
  return columns;
}

double UnitOf(const MotiveHeader& header, const CaptureText& text) {
  const std::string unit = header.Setting("length units");
  if (const auto metres = MetresPerUnit(unit)) return *metres;
  throw InputError(
      SourceLocation{text.file(), 1},
      "Length Units '" + Excerpt(unit) + "' is not known (Meters, Centimeters or Millimeters)");
}

}  // namespace

CapturedMarkers ReadMotiveCsv(CaptureText& text) {
  const MotiveHeader header = ReadMotiveHeader(text);
  WideMarkers markers(text, {.metres_per_unit = UnitOf(header, text)});
  std::vector<std::size_t> columns = PositionsOf(header, "marker");
  const std::size_t bodies = PositionsOf(header, "rigid body").size();
  std::vector<std::string> notes;
  if (columns.empty()) {
    columns = PositionsOf(header, "rigid body marker");
    if (!columns.empty() && LowerCase(header.Setting("coordinate space")) == "local") {
      throw InputError(SourceLocation{text.file(), 1},
                       "Coordinate Space is Local: these markers are in the frames of their rigid "
                       "bodies, which move; export in Global, and 'Markers'");
    }
    if (!columns.empty()) {
      notes.emplace_back(
          "the markers are those of rigid bodies, where the body's fit has them; export 'Markers' "
          "for what was measured");
    }
  }
  if (columns.empty()) {
    throw InputError(SourceLocation{text.file()},
                     "is a CSV file of Motive without markers: export it with 'Markers' chosen");
  }
  for (const std::size_t column : columns) markers.AddMarker(header.Cell("name", column), column);
  while (text.NextLine()) {
    if (!text.IsBlank()) markers.AddFrame(text.Require(1, "the time"));
  }
  double rate_Hz = 0.0;
  if (!ParseWithPointOrComma(header.Setting("export frame rate"), &rate_Hz)) rate_Hz = 0.0;
  CapturedMarkers captured = markers.Take(rate_Hz);
  if (bodies > 0) notes.push_back(std::to_string(bodies) + " rigid bodies are left out");
  notes.emplace_back(
      "Motive's y axis points up unless it was set otherwise: --axes x,-z,y makes it z, --register "
      "fits any axes");
  captured.notes = notes;
  return captured;
}

}  // namespace palpate::experiment
