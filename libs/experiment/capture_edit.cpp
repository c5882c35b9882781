// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/capture_edit.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::experiment {

namespace {

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else if (c != ' ') {
      parts.back() += c;
    }
  }
  return parts;
}

// "-y" -> (0, -1, 0), or zero where the word names no axis.
Eigen::RowVector3d ParseAxis(const std::string& word) {
  const bool negative = word.starts_with('-');
  const std::string name = word.substr(negative || word.starts_with('+') ? 1 : 0);
  Eigen::RowVector3d axis = Eigen::RowVector3d::Zero();
  if (name == "x" || name == "y" || name == "z") axis[name[0] - 'x'] = negative ? -1.0 : 1.0;
  return axis;
}

std::size_t RequireMarker(const MarkerTracks& tracks, const std::string& name) {
  const std::optional<std::size_t> index = tracks.IndexOf(name);
  if (index) return *index;
  std::string list;
  for (const std::string& known : tracks.names) list += (list.empty() ? "" : ", ") + known;
  throw InputError("there is no marker '" + name + "'" + DidYouMean(name, tracks.names) +
                   "; the file has " + list);
}

template <typename Value>
std::vector<Value> Picked(const std::vector<Value>& values, const std::vector<std::size_t>& picks) {
  std::vector<Value> picked;
  picked.reserve(picks.size());
  for (const std::size_t pick : picks) picked.push_back(values[pick]);
  return picked;
}

void PickFrames(const std::vector<std::size_t>& picks, CapturedMarkers& captured) {
  captured.tracks.frames = Picked(captured.tracks.frames, picks);
  if (!captured.residuals_m.empty()) captured.residuals_m = Picked(captured.residuals_m, picks);
  if (!captured.cameras.empty()) captured.cameras = Picked(captured.cameras, picks);
}

}  // namespace

Eigen::Matrix3d ParseAxes(const std::string& axes) {
  const std::vector<std::string> words = SplitAtCommas(axes);
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 3 && i < words.size(); ++i) {
    R.row(ToIndex(i)) = ParseAxis(words[i]);
  }
  const double determinant = words.size() == 3 ? R.determinant() : 0.0;
  if (determinant == 1.0) return R;
  if (determinant == -1.0) {
    throw InputError("axes '" + axes + "' mirror the data: one sign or the order is wrong");
  }
  throw InputError("axes '" + axes + "' must name x, y and z once each, such as \"z,-y,x\"");
}

void Rotate(const Eigen::Matrix3d& R, CapturedMarkers& captured) {
  captured.tracks = Transformed(captured.tracks, Eigen::Isometry3d(R));
}

void RenameMarkers(const std::map<std::string, std::string>& new_names, CapturedMarkers& captured) {
  std::vector<std::string> names = captured.tracks.names;
  for (const auto& [old_name, new_name] : new_names) {
    names[RequireMarker(captured.tracks, old_name)] = new_name;
  }
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) throw InputError("two markers would be called '" + name + "'");
  }
  captured.tracks.names = names;
}

void KeepMarkers(const std::vector<std::string>& names, CapturedMarkers& captured) {
  MarkerTracks& tracks = captured.tracks;
  std::vector<std::size_t> picks;
  for (const std::string& name : names) {
    const std::size_t index = RequireMarker(tracks, name);
    if (std::find(picks.begin(), picks.end(), index) != picks.end()) {
      throw InputError("marker '" + name + "' is listed twice");
    }
    picks.push_back(index);
  }
  tracks.names = Picked(tracks.names, picks);
  tracks.names_where = Picked(tracks.names_where, picks);
  for (MarkerFrame& frame : tracks.frames) frame.positions_m = Picked(frame.positions_m, picks);
  for (auto& residuals : captured.residuals_m) residuals = Picked(residuals, picks);
  for (auto& cameras : captured.cameras) cameras = Picked(cameras, picks);
}

void CropTime(const TimeWindow& window, CapturedMarkers& captured) {
  const std::vector<MarkerFrame>& frames = captured.tracks.frames;
  std::vector<std::size_t> picks;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (window.Contains(frames[i].t_s)) picks.push_back(i);
  }
  if (picks.empty()) {
    throw InputError("no frame lies between " + FormatNumber(window.begin_s) + " and " +
                     FormatNumber(window.end_s) + " s; the file has " +
                     FormatNumber(frames.front().t_s) + " to " + FormatNumber(frames.back().t_s) +
                     " s");
  }
  PickFrames(picks, captured);
}

void ThinFrames(double rate_Hz, CapturedMarkers& captured) {
  constexpr double kTolerance = 0.01;
  const double ratio = captured.rate_Hz / rate_Hz;
  const double step = std::round(ratio);
  if (!(step >= 1.0) || std::abs(ratio / step - 1.0) > kTolerance) {
    throw InputError("the file has " + FormatNumber(captured.rate_Hz) +
                     " frames a second, which is no whole multiple of " + FormatNumber(rate_Hz));
  }
  std::vector<std::size_t> picks;
  const auto stride = static_cast<std::size_t>(step);
  for (std::size_t i = 0; i < captured.tracks.frames.size(); i += stride) picks.push_back(i);
  PickFrames(picks, captured);
  captured.rate_Hz /= step;
}

void ShiftTime(double offset_s, CapturedMarkers& captured) {
  for (MarkerFrame& frame : captured.tracks.frames) frame.t_s += offset_s;
}

}  // namespace palpate::experiment
