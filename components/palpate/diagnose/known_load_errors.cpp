// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/diagnose/known_load_errors.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/offline/forces/force_replay.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "components/palpate/compare/force_comparison.hpp"
#include "components/palpate/estimate/estimate_settings.hpp"
#include "components/palpate/estimate/frame_progress.hpp"
#include "components/palpate/images/open_images.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

namespace {

/// Frames of one recording tell its error well enough.
constexpr double kMostFrames = 100.0;
constexpr auto kInput = robot::CableInput::kDisplacement;

using offline::EstimateFrom;
using offline::PlannedRecording;

/// One robot, and the experiment as its calibration corrects it.
struct Felt {
  const experiment::Experiment& experiment;
  robot::RobotModel* model = nullptr;
  robot::CalibrationFile calibration;  ///< of no robot: none was given
  const EstimateSettings& settings;
  const std::function<bool()>& stop_requested;
  FrameProgress* progress = nullptr;  ///< null: no progress is told
};

offline::ReplayLimits LimitsOf(const Felt& felt, double duration_s) {
  return {duration_s > 0.0 ? kMostFrames / duration_s : 0.0, felt.stop_requested,
          [progress = felt.progress](int done, int total) {
            if (progress != nullptr) progress->Update(done, total);
          }};
}

/// Zero where nothing acts; nothing where it is not observable.
std::optional<Eigen::Vector3d> ForceAt_N(const std::string& contact,
                                         const force_estimation::ForceEstimate& estimate) {
  if (estimate.status.code() == StatusCode::kNoContact) return Eigen::Vector3d::Zero();
  for (const force_estimation::ContactForce& one : estimate.contacts) {
    if (one.name != contact) continue;
    if (one.status.code() == StatusCode::kNoContact) return Eigen::Vector3d::Zero();
    if (HasForce(one)) return one.force_N;
  }
  return std::nullopt;
}

/// [known loads] of one frame, N; nothing where the frame, or a force of it, cannot be used.
std::optional<Eigen::VectorXd> ErrorsOf(const force_estimation::ForceEstimate& estimate,
                                        const experiment::Recording& recording) {
  if (!HasResult(estimate.status)) return std::nullopt;
  const auto sites = force_estimation::SitesOfLoads(recording.loads, estimate.t_s);
  Eigen::VectorXd errors_N(std::ssize(sites));
  Eigen::Index known = 0;
  for (const experiment::KnownLoad& load : experiment::LoadsAt(recording.loads, estimate.t_s)) {
    if (load.force_N.isZero(0.0)) continue;
    const auto force_N = ForceAt_N(sites[At(known)].name, estimate);
    if (!force_N) return std::nullopt;
    errors_N[known++] = (*force_N - load.force_N).dot(load.force_N.normalized());
  }
  return errors_N;
}

/// Keeps those of frames in which the robot is to be steady.
offline::TakeEstimate ErrorsInto(KnownLoadErrors* errors, const experiment::Recording& recording) {
  return [&recording, errors](const force_estimation::ForceEstimate& estimate) {
    if (recording.steady_window_s && !recording.steady_window_s->Contains(estimate.t_s)) return;
    const auto of_frame_N = ErrorsOf(estimate, recording);
    if (of_frame_N && of_frame_N->size() > 0)
      errors->emplace(std::pair(recording.name, estimate.t_s), *of_frame_N);
  };
}

void FeelMarkers(const Felt& felt, const experiment::Recording& recording,
                 const offline::MarkerTare& tare, KnownLoadErrors* errors) {
  const auto& frames = recording.markers->frames;
  const offline::MarkerReplay replay(
      {.experiment = felt.experiment,
       .model = felt.model,
       .cable_input = kInput,
       .limits = LimitsOf(felt, frames.back().t_s - frames.front().t_s),
       .tare = &tare,
       .knows_directions = true},
      felt.settings.forces, felt.calibration);
  replay.Estimate(recording, ErrorsInto(errors, recording));
}

/// 0 without images of the first camera.
double DurationOfImages_s(const experiment::Recording& recording) {
  const std::vector<experiment::StampedFile>& files =
      recording.clouds.empty() ? recording.depth_images : recording.clouds;
  return files.empty() ? 0.0 : files.back().t_s() - files.front().t_s();
}

void FeelImages(const Felt& felt, const std::vector<PlannedRecording>& plan,
                KnownLoadErrors* errors) {
  double longest_s = 0.0;
  for (const PlannedRecording& planned : plan)
    longest_s = std::max(longest_s, DurationOfImages_s(*planned.recording));
  offline::ForceReplay replay({.experiment = felt.experiment,
                               .model = felt.model,
                               .calibration = felt.calibration,
                               .calibration_name = "calibration.extended.yaml",
                               .cable_input = kInput,
                               .limits = LimitsOf(felt, longest_s),
                               .open = OpenImages},
                              felt.settings);
  replay.Prepare(plan);
  for (const PlannedRecording& planned : plan)
    replay.Estimate(planned, ErrorsInto(errors, *planned.recording));
}

}  // namespace

bool HasMeasuredLoads(const experiment::Recording& recording) {
  const bool is_loaded =
      std::any_of(recording.loads.begin(), recording.loads.end(),
                  [](const experiment::KnownLoad& load) { return !load.force_N.isZero(0.0); });
  return is_loaded && (recording.markers || offline::HasImages(recording));
}

KnownLoadErrors EstimateKnownLoads(const robot::RobotDescription& robot,
                                   const std::optional<robot::CalibrationFile>& calibration,
                                   const experiment::Experiment& experiment, Progress progress,
                                   const std::function<bool()>& stop_requested) {
  const EstimateSettings settings = ReadEstimateSettings(experiment, {}, {}, {});
  robot::RobotModel model(robot::BuildRobotBody(robot), fem::StaticSettings{},
                          {settings.forces.solver, settings.forces.threads});
  experiment::Experiment corrected = experiment;
  if (calibration) {
    robot::ApplyCalibration(*calibration, &model);
    offline::TakePoses(*calibration, &corrected);
    offline::CorrectPressures(*calibration, &corrected);
  }
  FrameProgress lines(model.body());
  const Felt felt{.experiment = corrected,
                  .model = &model,
                  .calibration = calibration.value_or(robot::CalibrationFile()),
                  .settings = settings,
                  .stop_requested = stop_requested,
                  .progress = progress == Progress::kReported ? &lines : nullptr};
  KnownLoadErrors errors;
  std::vector<PlannedRecording> from_images;
  std::optional<offline::MarkerTare> tare;
  for (const experiment::Recording& recording : corrected.recordings) {
    if (!HasMeasuredLoads(recording)) continue;
    if (!recording.markers) {
      from_images.push_back({&recording, EstimateFrom::kShape});
      continue;
    }
    if (!tare) tare.emplace(corrected, &model, kInput, settings.forces).Choose();
    FeelMarkers(felt, recording, *tare, &errors);
  }
  if (!from_images.empty()) FeelImages(felt, from_images, &errors);
  return errors;
}

}  // namespace palpate::command
