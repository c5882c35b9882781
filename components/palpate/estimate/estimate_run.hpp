// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/offline/forces/force_replay.hpp"
#include "components/palpate/estimate/estimate_settings.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/estimate/force_summary.hpp"
#include "components/palpate/estimate/forces_table.hpp"
#include "components/palpate/estimate/frame_progress.hpp"
#include "components/palpate/estimate/known_truth.hpp"
#include "components/palpate/estimate/recording_comparison.hpp"

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

  /// Checks the recordings, and finds the depth bias and the marker offsets that they need. Throws
  /// InputError; RunError where images do not fit the robot.
  void Prepare(const std::vector<offline::PlannedRecording>& plan);
  /// Also draws the plot where one is wanted; `is_only`: under the name that was given. Throws
  /// InputError, as the replays do.
  void Estimate(const offline::PlannedRecording& planned, bool is_only = true);
  /// Writes forces.csv; returns the exit code, kExitFailed where no frame has a result or a rest
  /// recording has forces. Throws RunError, and app::Interrupted where the run ended early.
  int Finish();

 private:
  void PrintComparison(const RecordingComparison& comparison);
  void Say(const std::string& note);

  const EstimateOptions& options_;
  robot::RobotModel& model_;
  std::function<bool()> stop_requested_;
  FrameProgress progress_;
  offline::ForceReplay replay_;
  std::optional<KnownTruth> truth_;
  ForcesTable table_;
  std::unique_ptr<nlohmann::ordered_json> json_;
  ComparisonSummary all_;  ///< of all recordings
  int compared_recordings_ = 0;
  int with_result_ = 0;
  offline::ReplayCount count_;  ///< of all recordings that were begun
  bool interrupted_ = false;
  bool rest_has_forces_ = false;  ///< a rest recording has more forces than chance gives
};

}  // namespace palpate::command
