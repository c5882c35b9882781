// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "libs/experiment/capture/capture_text.hpp"
#include "libs/experiment/captured_markers.hpp"

namespace palpate::experiment {

/// Puts together the markers of a table that has one line for each frame and three neighbouring
/// columns for each marker.
class WideMarkers {
 public:
  struct Options {
    double metres_per_unit = 1.0;
    bool zeros_are_gaps = false;  ///< 0, 0, 0 stands for a marker that was not seen
  };

  WideMarkers(const CaptureText& text, const Options& options);

  /// A marker whose x stands in `x_column`; y and z follow. Names without a meaning ("Unlabeled
  /// 12", "*3", none) become unlabelled_<number>. Throws InputError for a name given twice.
  void AddMarker(std::string_view name, std::size_t x_column);
  bool empty() const { return columns_.empty(); }

  /// The line at which `text` stands. Throws InputError where the time does not rise, for one or
  /// two coordinates of three, and for a position more than 50 m from the origin.
  void AddFrame(double t_s);

  /// Throws InputError where there is no marker or no frame. `rate_Hz` 0: that of the median step.
  CapturedMarkers Take(double rate_Hz);

 private:
  std::optional<Eigen::Vector3d> ReadPosition(std::size_t x_column) const;

  const CaptureText& text_;
  Options options_;
  std::vector<std::size_t> columns_;
  CapturedMarkers captured_;
};

/// Frames a second by the median step of time; 0 for a single frame.
double MedianRate(const std::vector<MarkerFrame>& frames);

}  // namespace palpate::experiment
