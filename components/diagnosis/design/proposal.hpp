// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// A weight that hangs on the body throughout a recording.
struct PlannedWeight {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the undeformed body
  double mass_kg = 0.0;
  double patch_radius_m = 0.0;
};

/// A recording that a bench could make.
struct Proposal {
  std::string title;    ///< "ramp of cable north to 20 mm"
  std::string by_hand;  ///< what a person does; empty: nothing
  /// Kind, tilt, commands from t_s = 0 and loads; no name and no markers yet.
  experiment::Recording recording;
  double duration_s = 0.0;
  std::optional<PlannedWeight> weight;
};

/// What can be done with this robot: each cable pulled a quarter farther than in these data, two
/// and all together, all one after the other quickly, each held for a minute, all let out, a weight
/// on two places, the base tilted about x and about y, both at once. Cables that these data drove
/// are driven in the way that they were (m or N); where none was, all are, by a share of the body's
/// size. Begins and ends with all commands at zero.
std::vector<Proposal> BenchProposals(const robot::RobotBody& body,
                                     const ObservedExperiment& observed);

}  // namespace palpate::diagnosis
