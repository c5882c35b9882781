// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>

#include "components/diagnosis/forward/fault_model.hpp"
#include "components/diagnosis/surface/surface_source.hpp"

namespace palpate::diagnosis {

/// A robot and what it has that the file's has not.
struct NearestRobot {
  ModelHypothesis hypothesis;
  std::optional<CauseName> exchanged = {};  ///< the cables; none: it is the file's
  double sample_s = 0.0;  ///< time that a sample of the file's robot took on one thread, s
};

/// Which robot stands nearest to where it was seen: the robot file's, or one with two of its cables
/// exchanged, if that is clearly nearer. Exchanged cables bend it so far to another side that a
/// linear model about the file's does not show them, and little of its surface would be matched.
/// All are tried, at one sample for each cable, of when that is pulled the most. `depth frames`:
/// nullptr where there are none; what they show goes before markers.
NearestRobot FindExchangedCables(const robot::RobotBody& body, const ObservedExperiment& observed,
                                 int threads, SurfaceSource* source);

}  // namespace palpate::diagnosis
