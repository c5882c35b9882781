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
  std::optional<LikelyFault> fault = {};  ///< what it has; none: it is the file's
  double sample_s = 0.0;  ///< time that a sample of the file's robot took on one thread, s
};

/// Which robot stands nearest to where it was seen: the robot file's, or one with two of its cables
/// or tubes exchanged, or with a blocked valve, if that is clearly nearer. These bend it so far to
/// another side that a linear model about the file's does not show them, and little of its surface
/// would be matched. All are tried, at one sample for each actuator, of when that is driven the
/// most, and for chambers at one of each recording; none where the file's robot is much nearer than
/// these samples are to each other. `source`: nullptr where there are no depth frames; what they
/// show goes before markers.
NearestRobot FindNearestRobot(const robot::RobotBody& body, const ObservedExperiment& observed,
                              int threads, SurfaceSource* source);

}  // namespace palpate::diagnosis
