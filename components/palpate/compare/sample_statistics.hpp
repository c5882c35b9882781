// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

namespace palpate::command {

/// NaN: no values.
double Mean(const std::vector<double>& values);

/// The smallest value that a share of at least `share` (0 to 1) of them does not exceed; for the
/// median of an even number the upper one. NaN: no values.
double Quantile(std::vector<double> values, double share);

}  // namespace palpate::command
