// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/palpate/compare/force_comparison.hpp"

namespace palpate::command {

/// One frame in one line: time, status, and each contact with its estimate and the truth, as
/// "12.3 s  ok  blue_ball 0.512 +- 0.031 N at (23, -22, 103) mm, true 0.505 N". `compared`: of
/// CompareFrame; empty: the estimates alone.
std::string LiveLine(const force_estimation::ForceEstimate& estimate,
                     const std::vector<ComparedForce>& compared);

/// At most `columns` characters of it, cut with "...".
std::string Cut(const std::string& line, std::size_t columns);

}  // namespace palpate::command
