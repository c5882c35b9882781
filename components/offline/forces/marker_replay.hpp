// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/force_estimate.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "components/offline/forces/marker_tare.hpp"
#include "components/offline/forces/replay_limits.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::offline {

/// Takes the estimate of one frame.
using TakeEstimate = std::function<void(const force_estimation::ForceEstimate&)>;

/// Passes the markers of recordings through force_estimation::MarkerPipeline. Each recording has a
/// pipeline of its own. Its marker offsets are those of its rest window, else of the contact-free
/// recordings (MarkerTare), else zero.
class MarkerReplay {
 public:
  struct Inputs {
    const experiment::Experiment& experiment;  ///< must outlive the replay, as the model
    robot::RobotModel* model = nullptr;        ///< `calibration` was applied to it
    robot::CableInput cable_input = robot::CableInput::kDisplacement;
    ReplayLimits limits{};
    const MarkerTare* tare = nullptr;  ///< none: no offsets without a rest window
    bool knows_directions = false;     ///< of known loads: only their sizes are estimated
  };

  MarkerReplay(const Inputs& inputs, const force_estimation::Config& config,
               const robot::CalibrationFile& calibration)
      : inputs_(inputs), config_(config), calibration_(calibration) {}

  /// Hands the estimate of each frame to `take`; all frames of a reference window are among them.
  /// Without contacts in the settings, known loads are contacts of known place. Throws InputError
  /// as force_estimation::FramesOfRecording does, for a load far from the body, and for markers at
  /// rest that do not have the robot's shape, orientation or place
  /// (force_estimation::CheckRestMarkers).
  ReplayCount Estimate(const experiment::Recording& recording, const TakeEstimate& take) const;

 private:
  void CountCalibratedPose(const experiment::Recording& recording,
                           std::vector<force_estimation::MarkerFrame>* frames) const;
  void CheckAtRest(const experiment::Recording& recording,
                   const std::vector<force_estimation::MarkerFrame>& frames) const;

  Inputs inputs_;
  force_estimation::Config config_;
  robot::CalibrationFile calibration_;
};

}  // namespace palpate::offline
