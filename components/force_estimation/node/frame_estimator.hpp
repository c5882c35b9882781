// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>

#include "components/force_estimation/node/frame_input.hpp"
#include "components/force_estimation/node/node_config.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What the worker runs on each frame of a sequence.
class FrameEstimator {
 public:
  virtual ~FrameEstimator() = default;
  virtual FrameResult Update(FrameInput& input) = 0;
  /// What can wait until the result of `input` is out; its results go out with the next one.
  virtual void AfterUpdate(const FrameInput& /*input*/) {}
};

using FrameEstimatorMaker = std::function<std::unique_ptr<FrameEstimator>(robot::RobotModel&)>;

/// What changes the model between two frames.
struct NewCalibration {
  robot::CalibrationFile calibration;  ///< CheckCalibration is ok
  FrameEstimatorMaker maker;           ///< of estimators from now on; empty: as before
};

/// Where the frames come from, by the settings: "markers" or "shape".
bool IsFromShape(const NodeConfig& config);

/// MarkerForceEstimator or ShapeForceEstimator for a model that has been given `calibration`, of
/// which the moduli's errors and the depth bias count. What is made throws InputError for settings
/// that do not fit the robot.
FrameEstimatorMaker EstimatorMakerOf(const NodeConfig& config,
                                     const robot::CalibrationFile& calibration);

}  // namespace palpate::force_estimation
