// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/palpate/estimate/estimate_settings.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// What looks at a frame and what feels the forces in it, each going on from one frame to the next.
struct ShapeSenses {
  /// A sequence of images begins: perception::Perception::SetCamera.
  std::function<void(const rgbd::RgbdCamera&)> open_camera;
  /// perception::Perception::Update
  std::function<const perception::Observation&(const rgbd::RgbdFrame&,
                                               const perception::PredictedSurface*)>
      look;
  /// force_estimation::ShapeForceEstimator::Update
  std::function<const force_estimation::ForceEstimate&(const force_estimation::ShapeFrame&)> feel;
};

/// The algorithms of palpate-perception and palpate-force-estimation. `model` must outlive them;
/// of `calibration`, which `model` has been given, the moduli's errors and the depth bias count.
/// Throws InputError for settings that do not go together and for a robot without feature points;
/// open_camera for images of another size or lens than the depth bias is for.
ShapeSenses MakeShapeSenses(const EstimateSettings& settings, robot::RobotModel* model,
                            const robot::CalibrationFile& calibration = {});

}  // namespace palpate::command
