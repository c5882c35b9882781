// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/markers.hpp"

#include <algorithm>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/marker_table.hpp"

namespace palpate::experiment {

namespace {

void CheckWritable(const std::string& name) {
  const bool blank_end = !name.empty() && (name.front() == ' ' || name.back() == ' ');
  if (name.empty() || blank_end || name.find_first_of(",\"\r\n\t") != std::string::npos) {
    throw InputError("marker name '" + name +
                     "' is not allowed in a CSV file (empty, or has a comma, a quote or an outer "
                     "blank); give it another name");
  }
}

// Sums for the straight line through the samples of one marker, time counted from the first.
struct LineFit {
  int count = 0;
  double t0_s = 0.0;
  double sum_t = 0.0;
  double sum_tt = 0.0;
  Eigen::Vector3d p0 = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_p = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_pp = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_tp = Eigen::Vector3d::Zero();

  void Add(double t_s, const Eigen::Vector3d& position_m) {
    if (count++ == 0) {
      t0_s = t_s;
      p0 = position_m;
    }
    const double t = t_s - t0_s;
    const Eigen::Vector3d p = position_m - p0;
    sum_t += t;
    sum_tt += t * t;
    sum_p += p;
    sum_pp += p.cwiseProduct(p);
    sum_tp += t * p;
  }

  MarkerMean Result() const {
    MarkerMean result;
    result.count = count;
    if (count == 0) return result;
    result.mean_m = p0 + sum_p / count;
    if (count < 3) return result;
    const double S_tt = sum_tt - sum_t * sum_t / count;
    const Eigen::Vector3d S_tp = sum_tp - sum_t * sum_p / count;
    const Eigen::Vector3d S_pp = sum_pp - sum_p.cwiseProduct(sum_p) / count;
    const Eigen::Vector3d about_line = S_pp - S_tp.cwiseProduct(S_tp) / S_tt;
    result.deviation_m = (about_line.cwiseMax(0.0) / (count - 2)).cwiseSqrt();
    return result;
  }
};

}  // namespace

std::optional<std::size_t> MarkerTracks::IndexOf(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

MarkerTracks ReadMarkers(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Read(file);
  ColumnFinder finder(table);
  MarkerColumns columns;
  columns.time = finder.Require("t_s");
  columns.marker = finder.Require("marker");
  columns.position = {finder.Require("x_m"), finder.Require("y_m"), finder.Require("z_m")};
  finder.Finish();
  return ReadMarkerTable(table, columns).tracks;
}

void WriteMarkers(const MarkerTracks& markers, const std::filesystem::path& file) {
  for (const std::string& name : markers.names) CheckWritable(name);
  std::string text = "t_s,marker,x_m,y_m,z_m\n";
  for (const MarkerFrame& frame : markers.frames) {
    const std::string time = FormatNumber(frame.t_s);
    for (std::size_t i = 0; i < markers.names.size(); ++i) {
      text += time + ',' + markers.names[i];
      const std::optional<Eigen::Vector3d>& position_m = frame.positions_m[i];
      for (int axis = 0; axis < 3; ++axis) {
        text += ',';
        if (position_m) text += FormatNumber((*position_m)[axis]);
      }
      text += '\n';
    }
  }
  WriteFile(file, text);
}

MarkerTracks Transformed(const MarkerTracks& markers, const Eigen::Isometry3d& T_target_source) {
  MarkerTracks result = markers;
  for (MarkerFrame& frame : result.frames) {
    for (std::optional<Eigen::Vector3d>& position_m : frame.positions_m) {
      if (position_m) *position_m = T_target_source * *position_m;
    }
  }
  return result;
}

std::vector<MarkerMean> MeanOver(const MarkerTracks& markers, const TimeWindow& window) {
  std::vector<LineFit> fits(markers.names.size());
  for (const MarkerFrame& frame : markers.frames) {
    if (!window.Contains(frame.t_s)) continue;
    for (std::size_t i = 0; i < fits.size(); ++i) {
      if (frame.positions_m[i]) fits[i].Add(frame.t_s, *frame.positions_m[i]);
    }
  }
  std::vector<MarkerMean> means;
  means.reserve(fits.size());
  for (const LineFit& fit : fits) means.push_back(fit.Result());
  return means;
}

}  // namespace palpate::experiment
