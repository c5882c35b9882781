// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::offline {

/// Constant marker offsets from contact-free recordings, for recordings without a rest window of
/// their own. A recording of kind rest is used, over its static phase, if it has markers and no
/// force is found in it.
class MarkerTare {
 public:
  /// The experiment must outlive the tare. `model`: as it estimates, used during the calls.
  MarkerTare(const experiment::Experiment& experiment, robot::RobotModel* model,
             robot::CableInput cable_input, const force_estimation::Config& config);

  /// Checks the contact-free recordings. Returns what there is to say: which are used, and each
  /// that is not, with its reason. Throws InputError as force_estimation::FramesOfRecording does.
  std::vector<std::string> Choose();

  /// Reference frames for `recording`, of the other contact-free recordings with the same
  /// T_robot_measurement, or of itself where there is no other. Empty where there is none.
  std::vector<force_estimation::MarkerFrame> FramesFor(
      const experiment::Recording& recording) const;

 private:
  using Frames = std::vector<force_estimation::MarkerFrame>;
  struct Source {
    const experiment::Recording* recording;
    Frames frames;  ///< of the static phase, marked as reference
  };

  Frames StaticFrames(const experiment::Recording& recording) const;
  bool FindsForce(const Frames& reference, const Frames& frames) const;

  const experiment::Experiment& experiment_;
  robot::RobotModel* model_;
  robot::CableInput cable_input_;
  force_estimation::Config config_;
  std::vector<Source> sources_;
};

}  // namespace palpate::offline
