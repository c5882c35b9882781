// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Takes the estimate of one frame.
using TakeEstimate = std::function<void(const force_estimation::ForceEstimate&)>;

/// Forces from the markers of recordings. One estimator for each recording: what it learns from one
/// (where the markers stand at rest) does not hold for the next.
class MarkerPipeline {
 public:
  /// `experiment` and `model` must outlive it. `modulus_error`: relative, one sigma.
  MarkerPipeline(force_estimation::Config config, robot::CableInput cable_input,
                 const experiment::Experiment& experiment, robot::RobotModel* model,
                 double modulus_error);

  /// Throws InputError as force_estimation::FramesOfRecording does.
  void Estimate(const experiment::Recording& recording, const TakeEstimate& take);

 private:
  force_estimation::Config config_;
  robot::CableInput cable_input_;
  const experiment::Experiment& experiment_;
  robot::RobotModel& model_;
  Eigen::Vector3d gravity_m_s2_;
  double modulus_error_;
};

}  // namespace palpate::command
