// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/view/plot/time_plot.hpp"
#include "libs/plot/plot_area.hpp"

namespace palpate::view {

using plot::AxisRange;
using plot::PlotArea;
using plot::SvgPoint;

/// What the value axis of a panel has to hold: the values, and the bands as far as they do not
/// dwarf them. From 0 to 1 where there are no values.
AxisRange ValueRange(const PlotPanel& panel);

/// The stretches of a line between its gaps.
std::vector<std::vector<SvgPoint>> Stretches(const TimeSeries& series, const PlotArea& area);

/// The outlines of the band, one for each stretch that has one.
std::vector<std::vector<SvgPoint>> BandOutlines(const TimeSeries& series, const PlotArea& area);

}  // namespace palpate::view
