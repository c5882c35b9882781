// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/pose/unlabelled_calibration.hpp"
#include "components/palpate/calibrate/assignment_picture.hpp"
#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// What a calibration from points without names starts from.
struct PointsWithoutNames {
  std::vector<const experiment::Recording*> recordings;
  std::vector<calibration::UnlabelledFrame> frames;
  std::vector<PictureGround> grounds;  ///< [frames] to draw on; none: plain
  calibration::UnlabelledSettings settings;
};

/// Tells which point is which marker, calibrates, says and draws what came of it. Throws RunError
/// where the points do not determine it.
robot::CalibrationFile CalibrateFromPoints(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment,
                                           const PointsWithoutNames& points,
                                           robot::RobotModel* model);

}  // namespace palpate::command
