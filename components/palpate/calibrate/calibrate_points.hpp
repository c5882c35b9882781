// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/pose/unlabelled_calibration.hpp"
#include "components/palpate/calibrate/assignment_plot.hpp"
#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The data of a calibration from points without names.
struct PointsWithoutNames {
  std::vector<const experiment::Recording*> recordings;
  std::vector<calibration::UnlabelledFrame> frames;
  std::vector<PlotGround> grounds;  ///< [frames] images to draw on; empty: none
  calibration::UnlabelledSettings settings;
};

/// Assigns points to markers, calibrates, prints and draws the result. Throws RunError where the
/// points do not determine it.
robot::CalibrationFile CalibrateFromPoints(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment,
                                           const PointsWithoutNames& points,
                                           robot::RobotModel* model);

}  // namespace palpate::command
