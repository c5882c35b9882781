// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/marker_table.hpp"

#include <cmath>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>

#include "libs/core/text.hpp"
#include "libs/experiment/csv_columns.hpp"

namespace palpate::experiment {

namespace {

// Builds the frames row by row. Markers named later than a frame are filled in by Finish().
class FrameBuilder {
 public:
  FrameBuilder(const CsvTable& table, const MarkerColumns& columns)
      : table_(table), columns_(columns) {}

  void AddRow(std::size_t row) {
    const double t_s = RisingTime(table_, row, columns_.time, Rise::kOrEqual);
    if (row == 0 || t_s != result_.tracks.frames.back().t_s) BeginFrame(t_s, row);
    const std::size_t marker = MarkerOf(row);
    if (marker >= seen_in_frame_.size()) seen_in_frame_.resize(marker + 1, 0);
    if (seen_in_frame_[marker] == result_.tracks.frames.size()) {
      table_.Refuse(row, columns_.marker, "a second sample of this marker for this time");
    }
    seen_in_frame_[marker] = result_.tracks.frames.size();
    StoreSample(row, marker);
  }

  MarkerTable Finish() {
    const std::size_t count = result_.tracks.names.size();
    for (MarkerFrame& frame : result_.tracks.frames) frame.positions_m.resize(count);
    for (auto& residuals : result_.residuals_m) residuals.resize(count);
    return std::move(result_);
  }

 private:
  void BeginFrame(double t_s, std::size_t row) {
    const std::size_t count = result_.tracks.names.size();
    MarkerFrame& frame = result_.tracks.frames.emplace_back();
    frame.t_s = t_s;
    frame.line = table_.Line(row);
    frame.positions_m.resize(count);
    unlabelled_in_frame_ = 0;
    if (columns_.residual) result_.residuals_m.emplace_back(count);
  }

  std::size_t MarkerOf(std::size_t row) {
    std::string_view name = table_.Text(row, columns_.marker);
    if (name.empty()) name = NextUnlabelled();
    const auto [entry, is_new] = index_of_.try_emplace(name, result_.tracks.names.size());
    if (is_new) {
      result_.tracks.names.emplace_back(name);
      result_.tracks.names_where.push_back(table_.Where(row, columns_.marker));
    }
    return entry->second;
  }

  std::string_view NextUnlabelled() {
    const std::size_t number = ++unlabelled_in_frame_;
    if (number > unlabelled_.size()) {
      unlabelled_.push_back(std::string(kUnlabelledPrefix) + std::to_string(number));
    }
    return unlabelled_[number - 1];
  }

  void StoreSample(std::size_t row, std::size_t marker) {
    MarkerFrame& frame = result_.tracks.frames.back();
    if (marker >= frame.positions_m.size()) frame.positions_m.resize(marker + 1);
    const std::optional<double> residual_m = ReadResidual(row);
    if (!residual_m || *residual_m >= 0.0) frame.positions_m[marker] = ReadPosition(row);
    if (!columns_.residual) return;
    auto& residuals = result_.residuals_m.back();
    if (marker >= residuals.size()) residuals.resize(marker + 1);
    if (frame.positions_m[marker]) residuals[marker] = residual_m;
  }

  std::optional<double> ReadResidual(std::size_t row) const {
    if (!columns_.residual) return std::nullopt;
    const std::optional<double> residual = table_.OptionalSample(row, *columns_.residual);
    if (!residual) return std::nullopt;
    return *residual * columns_.residual_metres_per_unit;
  }

  std::optional<Eigen::Vector3d> ReadPosition(std::size_t row) const {
    Eigen::Vector3d position_m;
    int missing = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const std::optional<double> value = table_.OptionalSample(row, columns_.position[i]);
      if (!value) ++missing;
      position_m[axis] = value.value_or(0.0) * columns_.metres_per_unit[i];
      if (std::abs(position_m[axis]) > kLargestCoordinate_m) {
        table_.Refuse(row, columns_.position[i],
                      "more than " + FormatNumber(kLargestCoordinate_m) +
                          " m from the origin; is this another unit?");
      }
    }
    if (missing == 3) return std::nullopt;
    if (missing > 0) {
      table_.Refuse(row, columns_.marker,
                    "a position has three coordinates, or none where the marker was not seen");
    }
    return position_m;
  }

  const CsvTable& table_;
  const MarkerColumns& columns_;
  MarkerTable result_;
  std::unordered_map<std::string_view, std::size_t> index_of_;
  std::deque<std::string> unlabelled_;  // names made up, which index_of_ points to
  std::size_t unlabelled_in_frame_ = 0;
  std::vector<std::size_t> seen_in_frame_;  // number of the frame, from 1, of the last sample
};

}  // namespace

MarkerTable ReadMarkerTable(const CsvTable& table, const MarkerColumns& columns) {
  if (table.rows() == 0) throw InputError(SourceLocation{table.file(), 2, 1}, "no row of samples");
  FrameBuilder builder(table, columns);
  for (std::size_t row = 0; row < table.rows(); ++row) builder.AddRow(row);
  return builder.Finish();
}

}  // namespace palpate::experiment
