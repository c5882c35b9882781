// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/images/perception_settings.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Where the camera stands, roughly: --camera-pose, else the experiment's; nothing where neither
/// says it.
std::optional<Eigen::Isometry3d> RoughPose(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment);

/// Where it stood at the calibration of --earlier; nothing without that. Throws InputError where
/// the file is not this robot's, or says nothing of it.
std::optional<Eigen::Isometry3d> EarlierPose(const CalibrateOptions& options,
                                             const robot::RobotModel& model);

geometry::RigidTransform ToTransform(const Eigen::Isometry3d& T);

/// The recordings whose images serve to find the camera: those that are named, or all with depth,
/// the camera where it always stood, and without unknown contacts. Throws InputError where there is
/// none.
std::vector<const experiment::Recording*> RecordingsWithImages(
    const CalibrateOptions& options, const experiment::Experiment& experiment);

}  // namespace palpate::command
