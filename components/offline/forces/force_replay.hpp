// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/offline/forces/estimate_plan.hpp"
#include "components/offline/forces/force_settings.hpp"
#include "components/offline/forces/marker_replay.hpp"
#include "components/offline/forces/marker_tare.hpp"
#include "components/offline/forces/shape_replay.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::offline {

/// Contact-free frames that the depth bias is estimated from: FindBiasFrames; the first
/// shape.untouched_frames frames (all else, too, is as the processes do it); none.
enum class BiasFrom { kRecordings, kFirst, kNone };

/// The calibration's camera poses, with their errors, in the place of the experiment's.
void TakePoses(const robot::CalibrationFile& calibration, experiment::Experiment* experiment);

/// The pose's priors of the settings, or the largest error that the experiment states of a camera's
/// pose where that is larger.
void WidenPosePriors(const experiment::Experiment& experiment,
                     force_estimation::ShapeConfig* shape);

/// Perception and pipeline for images of the experiment's cameras: `cameras` beside the first.
/// `model`, to which `calibration` was applied, must outlive it. Throws InputError.
ShapeStream MakeShapeStream(robot::RobotModel& model, const ForceSettings& settings,
                            const robot::CalibrationFile& calibration,
                            const std::vector<std::string>& cameras, BiasFrom bias);

/// Forces of an experiment's recordings, from images or markers: what `palpate estimate` and the
/// Python package do.
class ForceReplay {
 public:
  struct Inputs {
    /// With the poses of the calibration (TakePoses); must outlive the replay, as the model.
    const experiment::Experiment& experiment;
    robot::RobotModel* model = nullptr;  ///< `calibration` was applied to it
    robot::CalibrationFile calibration{};
    std::string calibration_name;  ///< for messages; empty: none was given
    robot::CableInput cable_input = robot::CableInput::kDisplacement;
    BiasFrom bias = BiasFrom::kRecordings;
    ReplayLimits limits{};
    ImageOpener open{};
    std::function<void(const std::string&)> note{};  ///< takes what there is to say
  };

  ForceReplay(Inputs inputs, ForceSettings settings);

  /// Checks the loads and images of the planned recordings, and finds the depth bias and the marker
  /// offsets that they need. Throws InputError; RunError where images do not fit the robot
  /// (RequireImagesFit).
  void Prepare(const std::vector<PlannedRecording>& plan);

  struct Result {
    ReplayCount count;
    std::optional<std::string> failure;  ///< of a rest recording that has forces (RestCheck)
  };
  /// Hands the estimate of each frame to `take`. After Prepare. Throws InputError.
  Result Estimate(const PlannedRecording& planned, const TakeEstimate& take);

 private:
  std::unique_ptr<ShapeReplay> MakeShapeReplay() const;
  void CheckImages(const std::vector<PlannedRecording>& plan) const;
  void FindDepthBias(const std::vector<PlannedRecording>& plan);
  void FindMarkerOffsets(const std::vector<PlannedRecording>& plan);
  ReplayCount Replay(const PlannedRecording& planned, const TakeEstimate& take);
  void Say(const std::string& text) const;

  Inputs inputs_;
  ForceSettings settings_;
  std::unique_ptr<ShapeReplay> shape_;  ///< created when first needed
  std::unique_ptr<MarkerTare> tare_;    ///< created where it is needed
};

}  // namespace palpate::offline
