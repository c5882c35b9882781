// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/diagnosis/report/figures/figure.hpp"
#include "libs/plot/axis_ticks.hpp"

namespace palpate::diagnosis {

/// Residuals over something, before and after, in the order in which they were measured.
struct TracePanel {
  std::string title;
  std::string note;     ///< a second line, muted
  std::string x_title;  ///< with its unit
  std::vector<double> x;
  plot::AxisRange x_range;
  plot::AxisTicks x_ticks;
  std::vector<double> before_mm, after_mm;  ///< as long as x; NaN: not known
  bool directed = false;                    ///< arrow heads show the way of time
};

/// Two panels in a row; an svg element.
std::string DrawTracePanels(const std::string& id, const std::vector<TracePanel>& panels,
                            bool show_after);

}  // namespace palpate::diagnosis
