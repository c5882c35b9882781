// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/palpate/estimate/estimate_plan.hpp"
#include "components/palpate/estimate/estimate_settings.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/estimate/force_summary.hpp"
#include "components/palpate/estimate/forces_table.hpp"
#include "components/palpate/estimate/known_truth.hpp"
#include "components/palpate/estimate/marker_tare.hpp"
#include "components/palpate/estimate/recording_comparison.hpp"
#include "components/palpate/estimate/replay_limits.hpp"
#include "components/palpate/estimate/rest_check.hpp"
#include "components/palpate/estimate/shape_replay.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

/// One run of `palpate estimate`: prints each recording's summary and collects forces.csv.
class EstimateRun {
 public:
  /// Applies the calibration to model and experiment. All arguments must outlive the run, which
  /// ends early where `stop_requested`. Throws InputError.
  EstimateRun(const EstimateOptions& options, const EstimateSettings& settings,
              experiment::Experiment* experiment, robot::RobotModel* model,
              std::function<bool()> stop_requested = {});
  ~EstimateRun();

  /// Processes the contact-free recordings, where one of `plan` is estimated from its shape. Throws
  /// RunError where images do not fit the robot (RequireImagesFit).
  void EstimateDepthBias(const std::vector<PlannedRecording>& plan);
  /// Chooses the recordings that give marker offsets, where `plan` has markers without a rest
  /// window.
  void CalibrateMarkerOffsets(const std::vector<PlannedRecording>& plan);
  /// Also draws the plot where one is wanted; `is_only`: under the name that was given. Throws
  /// InputError, as the replays do.
  void Estimate(const PlannedRecording& planned, bool is_only = true);
  /// Writes forces.csv; returns the exit code, kExitFailed where no frame has a result or a rest
  /// recording has forces. Throws RunError, and app::Interrupted where the run ended early.
  int Finish();

 private:
  ShapeReplay& Shape();
  void CheckImages(const std::vector<PlannedRecording>& plan) const;
  RestCheck::Known RestCheckOf(const PlannedRecording& planned) const;
  ReplayCount Replay(const PlannedRecording& planned, const TakeEstimate& take);
  void PrintComparison(const RecordingComparison& comparison);
  ReplayLimits Limits() const { return {options_.rate_Hz, stop_requested_}; }
  std::unique_ptr<ShapeReplay> MakeShapeReplay() const;
  void Say(const std::string& note);

  const EstimateOptions& options_;
  const EstimateSettings& settings_;
  const experiment::Experiment& experiment_;
  robot::RobotModel& model_;
  robot::CalibrationFile calibration_;  ///< empty where none is given
  std::function<bool()> stop_requested_;
  std::optional<KnownTruth> truth_;
  std::unique_ptr<ShapeReplay> shape_;  ///< created when first needed
  std::unique_ptr<MarkerTare> tare_;    ///< created where it is needed
  ForcesTable table_;
  std::unique_ptr<nlohmann::ordered_json> json_;
  ComparisonSummary all_;  ///< of all recordings
  int compared_recordings_ = 0;
  int with_result_ = 0;
  ReplayCount count_;  ///< of all recordings that were begun
  bool interrupted_ = false;
  bool rest_has_forces_ = false;  ///< a rest recording has more forces than chance gives
};

}  // namespace palpate::command
