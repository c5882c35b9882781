// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/capture/wide_markers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/core/text.hpp"

namespace palpate::experiment {

WideMarkers::WideMarkers(const CaptureText& text, const Options& options)
    : text_(text), options_(options) {}

void WideMarkers::AddMarker(std::string_view name, std::size_t x_column) {
  std::string unique(name);
  if (HasNoName(name)) {
    unique = std::string(kUnlabelledPrefix) + std::to_string(columns_.size() + 1);
  }
  const auto& names = captured_.tracks.names;
  if (std::find(names.begin(), names.end(), unique) != names.end()) {
    text_.Refuse(x_column, "marker '" + Excerpt(unique) + "' is given twice");
  }
  captured_.tracks.names.push_back(unique);
  captured_.tracks.names_where.push_back(SourceLocation{text_.file(), text_.line_number(), 0});
  columns_.push_back(x_column);
}

std::optional<Eigen::Vector3d> WideMarkers::ReadPosition(std::size_t x_column) const {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  int missing = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<double> value = text_.Number(x_column + axis);
    if (!value) ++missing;
    position_m[ToIndex(axis)] = value.value_or(0.0) * options_.metres_per_unit;
    if (std::abs(position_m[ToIndex(axis)]) > kLargestCoordinate_m) {
      text_.Refuse(x_column + axis, "more than " + FormatNumber(kLargestCoordinate_m) +
                                        " m from the origin; is this another unit?");
    }
  }
  if (missing == 3 || (options_.zeros_are_gaps && position_m.isZero(0.0))) return std::nullopt;
  if (missing > 0) {
    text_.Refuse(x_column, "a position has three coordinates, or none where it was not seen");
  }
  return position_m;
}

void WideMarkers::AddFrame(double t_s) {
  auto& frames = captured_.tracks.frames;
  if (!frames.empty() && t_s <= frames.back().t_s) {
    text_.Refuse(0, "time must rise from line to line");
  }
  MarkerFrame frame{.t_s = t_s, .positions_m = {}, .line = text_.line_number()};
  for (const std::size_t column : columns_) frame.positions_m.push_back(ReadPosition(column));
  frames.push_back(std::move(frame));
}

CapturedMarkers WideMarkers::Take(double rate_Hz) {
  const SourceLocation where{text_.file()};
  if (columns_.empty()) throw InputError(where, "the header names no marker");
  if (captured_.tracks.frames.empty()) throw InputError(where, "no frame follows the header");
  captured_.rate_Hz = rate_Hz > 0.0 ? rate_Hz : MedianRate(captured_.tracks.frames);
  return std::move(captured_);
}

double MedianRate(const std::vector<MarkerFrame>& frames) {
  if (frames.size() < 2) return 0.0;
  std::vector<double> steps_s;
  steps_s.reserve(frames.size() - 1);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    steps_s.push_back(frames[i].t_s - frames[i - 1].t_s);
  }
  return 1.0 / UpperMedian(steps_s);
}

}  // namespace palpate::experiment
