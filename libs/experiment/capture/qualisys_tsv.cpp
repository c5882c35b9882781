// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cctype>
#include <map>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/capture/exports.hpp"
#include "libs/experiment/capture/wide_markers.hpp"
#include "libs/experiment/table_text.hpp"

namespace palpate::experiment {

namespace {

using Row = std::vector<std::string>;

constexpr double kMillimetre_m = 1e-3;
constexpr std::size_t kNumbersOfMarker = 3;
constexpr std::size_t kNumbersOfBody = 16;  // x, y, z, three angles, residual, nine of a rotation

/// Names of settings are words in upper case: NO_OF_FRAMES, FREQUENCY, EVENT, ...
bool NamesSetting(std::string_view cell) {
  const auto in_name = [](unsigned char c) {
    return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_';
  };
  return cell.size() > 3 && std::isupper(static_cast<unsigned char>(cell.front())) != 0 &&
         std::all_of(cell.begin(), cell.end(), in_name);
}

/// Lines "NAME<tab>value<tab>..." before the frames. At the end `text` stands at the line behind
/// them.
std::map<std::string, Row> ReadQualisysHeader(CaptureText& text) {
  std::map<std::string, Row> header;
  while (text.NextLine()) {
    const std::string_view name = text.Cell(0);
    if (!NamesSetting(name)) return header;
    header[std::string(name)] = Row(text.cells().begin() + 1, text.cells().end());
  }
  throw InputError(SourceLocation{text.file()}, "no frame follows the header");
}

std::string First(const std::map<std::string, Row>& header, const std::string& name) {
  const auto row = header.find(name);
  return row == header.end() || row->second.empty() ? "" : row->second.front();
}

Row NamesOf(const std::map<std::string, Row>& header, bool bodies, const CaptureText& text) {
  const std::string key = bodies ? "BODY_NAMES" : "MARKER_NAMES";
  const auto row = header.find(key);
  if (row == header.end()) throw InputError(SourceLocation{text.file()}, "has no line " + key);
  Row names = row->second;
  while (!names.empty() && names.back().empty()) names.pop_back();
  return names;
}

/// Whether the line names columns. Numbers may have a decimal comma.
bool HoldsTitles(const CaptureText& text) {
  const std::string_view first = text.Cell(0);
  if (first.empty()) return LowerCase(text.Cell(1)) == "x";
  return std::isalpha(static_cast<unsigned char>(first.front())) != 0 && !StandsForMissing(first);
}

/// Columns before the first coordinate: frame and time, or none. A line of column titles says it;
/// without one the count of numbers does.
std::size_t LeadOf(const CaptureText& text, bool titles, std::size_t numbers) {
  if (titles) {
    std::size_t lead = 0;
    while (LowerCase(text.Cell(lead)) == "frame" || LowerCase(text.Cell(lead)) == "time") ++lead;
    return lead;
  }
  std::size_t cells = text.cells().size();
  if (cells > 0 && text.cells().back().empty() && cells != numbers && cells != numbers + 2) --cells;
  if (cells != numbers && cells != numbers + 2) {
    text.Refuse(0, "the line has " + std::to_string(cells) + " numbers, the header names " +
                       std::to_string(numbers));
  }
  return cells - numbers;
}

}  // namespace

CapturedMarkers ReadQualisysTsv(CaptureText& text) {
  const std::map<std::string, Row> header = ReadQualisysHeader(text);
  const bool bodies = First(header, "DATA_INCLUDED") == "6D" || header.contains("BODY_NAMES");
  const Row names = NamesOf(header, bodies, text);
  double rate_Hz = 0.0;
  const std::string frequency = First(header, "FREQUENCY");
  if (!ParseWithPointOrComma(frequency, &rate_Hz) || !(rate_Hz > 0.0)) {
    throw InputError(SourceLocation{text.file()},
                     "FREQUENCY '" + Excerpt(frequency) + "' is no frame rate");
  }
  const std::size_t numbers_each = bodies ? kNumbersOfBody : kNumbersOfMarker;
  const bool titles = HoldsTitles(text);
  const std::size_t lead = LeadOf(text, titles, numbers_each * names.size());
  WideMarkers markers(text, {.metres_per_unit = kMillimetre_m, .zeros_are_gaps = true});
  for (std::size_t i = 0; i < names.size(); ++i) {
    markers.AddMarker(names[i], lead + i * numbers_each);
  }
  std::size_t frame = 0;
  for (bool more = !titles || text.NextLine(); more; more = text.NextLine()) {
    if (text.IsBlank()) continue;
    markers.AddFrame(lead == 2 ? text.Require(1, "the time")
                               : static_cast<double>(frame) / rate_Hz);
    ++frame;
  }
  CapturedMarkers captured = markers.Take(rate_Hz);
  if (bodies) {
    captured.notes.emplace_back(
        "rigid bodies (6D): their origins are imported as markers, without the rotations");
  }
  return captured;
}

}  // namespace palpate::experiment
