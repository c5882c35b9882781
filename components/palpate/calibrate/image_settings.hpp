// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "components/calibration/joint/pose_prior.hpp"
#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/images/perception_settings.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The approximate camera pose: --camera-pose, else the experiment's; nullopt where neither has
/// one.
std::optional<Eigen::Isometry3d> RoughPose(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment);

/// The camera pose of the calibration file --earlier; nullopt without that file. Throws InputError
/// where the file is not this robot's, or has no pose.
std::optional<Eigen::Isometry3d> EarlierPose(const CalibrateOptions& options,
                                             const robot::RobotModel& model);

/// The experiment's camera pose with its standard error; nullopt where it has none, or
/// --camera-pose replaces it by an approximate one.
std::optional<calibration::PosePrior> PriorOf(const CalibrateOptions& options,
                                              const experiment::Experiment& experiment);

geometry::RigidTransform ToTransform(const Eigen::Isometry3d& T);

/// The recordings whose images determine the camera pose: those that are named, or all with depth,
/// the camera at its usual pose, and without unknown contacts. Throws InputError where there is
/// none.
std::vector<const experiment::Recording*> RecordingsWithImages(
    const CalibrateOptions& options, const experiment::Experiment& experiment);

}  // namespace palpate::command
