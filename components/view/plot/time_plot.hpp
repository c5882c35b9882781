// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/view/picture/color.hpp"

namespace palpate::view {

/// One quantity over time. Where a value is not finite the line has a gap; a value alone between
/// two gaps is drawn as a dot.
struct TimeSeries {
  std::string name;  ///< in the legend, once for all panels; empty: not in it
  Color color = palette::kEstimate;
  bool dashed = false;
  std::vector<double> t_s;  ///< rising
  std::vector<double> values;
  std::vector<double> half_widths;  ///< of the band around the values, or none; not finite: no band
};

/// One frame of axes.
struct PlotPanel {
  std::string title;
  std::string value_title;  ///< quantity and unit as shown, e.g. "force (N)"
  bool from_zero = true;    ///< the value axis begins at 0 where no value is below
  std::vector<TimeSeries> series;
};

/// Panels above each other with one time axis.
struct TimePlot {
  int width_px = 900;
  int height_px = 500;
  std::string title;
  std::string caption;  ///< a line under the title
  std::string time_title = "time (s)";
  std::vector<PlotPanel> panels;
};

/// The plot as an SVG file. Throws RunError for a plot without panels, a series whose lists differ
/// in length, or a figure too small for its panels (60 px each).
std::string DrawTimePlot(const TimePlot& plot);

/// DrawTimePlot into a file. Throws RunError.
void SaveTimePlot(const std::filesystem::path& file, const TimePlot& plot);

}  // namespace palpate::view
