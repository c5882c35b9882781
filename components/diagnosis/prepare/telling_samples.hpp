// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// The samples that tell faults which are there or not, as exchanged cables, from the robot file's
/// robot.
struct Telling {
  ObservedExperiment observed;       ///< with these samples only
  std::vector<Eigen::Index> driven;  ///< [samples] the actuator of each; -1: none
};

/// The sample of each actuator in which that is driven apart from the others the most. Of chambers
/// one of each recording, which tell from when on a valve is blocked, and the least driven sample,
/// whose shape a blocked valve keeps. `in_frames`: samples must have depth frames, else markers.
Telling OfMostDriven(const ObservedExperiment& observed, const robot::RobotBody& body,
                     bool in_frames);

}  // namespace palpate::diagnosis
