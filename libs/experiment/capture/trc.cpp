// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <map>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/capture/exports.hpp"
#include "libs/experiment/capture/wide_markers.hpp"

namespace palpate::experiment {

namespace {

void TakeHeaderLine(CaptureText& text, const std::string& what) {
  do {
    if (!text.NextLine()) throw InputError(SourceLocation{text.file()}, "ends before " + what);
  } while (text.IsBlank());
}

/// Names stand over their first column, or in neighbouring columns: the k-th has columns 3 k.
void AddMarkers(CaptureText& text, const std::string& count, WideMarkers* markers) {
  TakeHeaderLine(text, "the names of the markers");
  constexpr std::size_t kFirst = 2;  // behind Frame# and Time
  std::size_t names = 0;
  for (std::size_t column = kFirst; column < text.cells().size(); ++column) {
    if (!text.Cell(column).empty()) {
      markers->AddMarker(text.Cell(column), kFirst + 3 * names++);
    }
  }
  double told = 0.0;
  if (ParseFinite(count, &told) && told != static_cast<double>(names)) {
    text.Refuse(kFirst,
                "NumMarkers is " + count + ", and " + std::to_string(names) + " names stand here");
  }
}

}  // namespace

CapturedMarkers ReadTrc(CaptureText& text) {
  TakeHeaderLine(text, "PathFileType");
  TakeHeaderLine(text, "the names of its settings");
  const std::vector<std::string> keys(text.cells().begin(), text.cells().end());
  TakeHeaderLine(text, "its settings");
  std::map<std::string, std::string> settings;
  for (std::size_t i = 0; i < keys.size(); ++i) settings[LowerCase(keys[i])] = text.Cell(i);
  double rate_Hz = 0.0;
  if (!ParseWithPointOrComma(settings["datarate"], &rate_Hz) || !(rate_Hz > 0.0)) {
    text.Refuse(0, keys.size() < 2
                       ? "a TRC file has tabs between its columns"
                       : "DataRate '" + Excerpt(settings["datarate"]) + "' is no frame rate");
  }
  const auto metres_per_unit = MetresPerUnit(settings["units"]);
  if (!metres_per_unit) {
    text.Refuse(0, "Units '" + Excerpt(settings["units"]) + "' is not known (mm, cm or m)");
  }
  WideMarkers markers(text, {.metres_per_unit = *metres_per_unit});
  AddMarkers(text, settings["nummarkers"], &markers);
  TakeHeaderLine(text, "the axes");
  while (text.NextLine()) {
    if (!text.IsBlank()) markers.AddFrame(text.Require(1, "the time"));
  }
  return markers.Take(rate_Hz);
}

}  // namespace palpate::experiment
