// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::plot {

/// A stretch of an axis, lower < upper.
struct AxisRange {
  double lower = 0.0;
  double upper = 1.0;
};

/// The marks of an axis: round values with their texts, all inside the range.
struct AxisTicks {
  std::vector<double> values;
  std::vector<std::string> labels;
};

/// About `count` marks, 1, 2 or 5 times a power of ten apart, at least two. Throws RunError for a
/// range that is empty, upside down or not finite.
AxisTicks MakeTicks(const AxisRange& range, int count);

/// The smallest range of whole mark distances around `range`; where that is a single value, one
/// around it.
AxisRange RoundOutward(const AxisRange& range, int count);

/// A number with so many digits after the point, C locale; never "-0".
std::string FixedText(double value, int decimals);

}  // namespace palpate::plot
