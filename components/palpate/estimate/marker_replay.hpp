// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/force_estimate.hpp"
#include "components/palpate/estimate/replay_limits.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Takes the estimate of one frame.
using TakeEstimate = std::function<void(const force_estimation::ForceEstimate&)>;

/// Passes the markers of recordings through force_estimation::MarkerPipeline. Each recording has a
/// pipeline of its own: marker offsets of one do not hold for the next.
class MarkerReplay {
 public:
  struct Inputs {
    const experiment::Experiment& experiment;  ///< must outlive the replay, as the model
    robot::RobotModel* model = nullptr;        ///< `calibration` was applied to it
    robot::CableInput cable_input = robot::CableInput::kDisplacement;
    ReplayLimits limits{};
  };

  MarkerReplay(const Inputs& inputs, const force_estimation::Config& config,
               const robot::CalibrationFile& calibration)
      : inputs_(inputs), config_(config), calibration_(calibration) {}

  /// Hands the estimate of each frame to `take`; all frames of a reference window are among them.
  /// Without contacts in the settings, known loads are contacts of known place. Throws InputError
  /// as force_estimation::FramesOfRecording does, and for a load far from the body.
  ReplayCount Estimate(const experiment::Recording& recording, const TakeEstimate& take) const;

 private:
  Inputs inputs_;
  force_estimation::Config config_;
  robot::CalibrationFile calibration_;
};

}  // namespace palpate::command
