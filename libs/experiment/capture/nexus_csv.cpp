// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/capture/exports.hpp"
#include "libs/experiment/capture/wide_markers.hpp"

namespace palpate::experiment {

namespace {

using Row = std::vector<std::string>;

void RequireLine(CaptureText& text, const std::string& what) {
  if (text.NextLine()) return;
  throw InputError(SourceLocation{text.file()}, "ends before " + what);
}

Row CellsOf(const CaptureText& text) { return {text.cells().begin(), text.cells().end()}; }

std::string CellAt(const Row& row, std::size_t column) {
  return column < row.size() ? row[column] : std::string();
}

double UnitIn(const CaptureText& text, std::size_t column) {
  const std::string_view unit = text.Cell(column);
  if (const auto metres = MetresPerUnit(unit)) return *metres;
  text.Refuse(column, "unit of length '" + Excerpt(unit) + "' is not known (mm, cm or m)");
}

}  // namespace

CapturedMarkers ReadNexusCsv(CaptureText& text) {
  do {
    RequireLine(text, "its section 'Trajectories'");
  } while (text.Cell(0) != "Trajectories");
  RequireLine(text, "the frame rate");
  const double rate_Hz = text.Require(0, "the frame rate");
  if (!(rate_Hz > 0.0)) text.Refuse(0, "the frame rate must be above 0");
  RequireLine(text, "the names of the markers");
  const Row names = CellsOf(text);
  RequireLine(text, "the axes");
  const Row axes = CellsOf(text);
  RequireLine(text, "the units");
  constexpr std::size_t kFirst = 2;  // behind frame and sub-frame
  WideMarkers markers(text, {.metres_per_unit = UnitIn(text, kFirst)});
  std::string name;
  for (std::size_t column = kFirst; column < axes.size(); ++column) {
    if (!CellAt(names, column).empty()) name = CellAt(names, column);
    // Velocities are X', accelerations X''.
    const bool position =
        axes[column] == "X" && CellAt(axes, column + 1) == "Y" && CellAt(axes, column + 2) == "Z";
    if (position) markers.AddMarker(name, column);
  }
  double first_frame = 0.0;
  bool any = false;
  while (text.NextLine() && !text.IsBlank()) {
    const double frame = text.Require(0, "the number of the frame");
    if (!any) first_frame = frame;
    any = true;
    markers.AddFrame((frame - first_frame) / rate_Hz);
  }
  return markers.Take(rate_Hz);
}

}  // namespace palpate::experiment
