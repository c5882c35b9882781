// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/diagnose/force_gain.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/offline/forces/marker_replay.hpp"
#include "components/offline/forces/marker_tare.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "components/palpate/compare/force_comparison.hpp"
#include "components/palpate/estimate/estimate_settings.hpp"
#include "components/palpate/estimate/frame_progress.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

namespace {

/// Frames of one recording tell its error well enough.
constexpr double kMostFrames = 100.0;

/// By recording and time: of each known load, estimated - known along it, N.
using ForceErrors = std::map<std::pair<std::string, double>, Eigen::VectorXd>;

bool HasKnownForces(const experiment::Recording& recording) {
  return recording.markers &&
         std::any_of(recording.loads.begin(), recording.loads.end(),
                     [](const experiment::KnownLoad& load) { return !load.force_N.isZero(0.0); });
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

/// As one robot feels the known loads.
ForceErrors Estimate(const robot::RobotDescription& robot,
                     const std::optional<robot::CalibrationFile>& calibration,
                     const experiment::Experiment& experiment,
                     const std::function<bool()>& stop_requested) {
  const force_estimation::Config config = ReadEstimateSettings(experiment, {}, {}, {}).forces;
  robot::RobotModel model(robot::BuildRobotBody(robot), fem::StaticSettings{},
                          {config.solver, config.threads});
  experiment::Experiment corrected = experiment;
  if (calibration) {
    robot::ApplyCalibration(*calibration, &model);
    offline::CorrectPressures(*calibration, &corrected);
  }
  constexpr auto kInput = robot::CableInput::kDisplacement;
  offline::MarkerTare tare(corrected, &model, kInput, config);
  tare.Choose();
  FrameProgress progress(model.body());
  ForceErrors errors;
  for (const experiment::Recording& recording : corrected.recordings) {
    if (!HasKnownForces(recording)) continue;
    const auto& frames = recording.markers->frames;
    const double duration_s = frames.back().t_s - frames.front().t_s;
    const double rate_Hz = duration_s > 0.0 ? kMostFrames / duration_s : 0.0;
    const offline::MarkerReplay replay(
        {.experiment = corrected,
         .model = &model,
         .cable_input = kInput,
         .limits = {rate_Hz, stop_requested,
                    [&](int done, int total) { progress.Update(done, total); }},
         .tare = &tare,
         .knows_directions = true},
        config, calibration.value_or(robot::CalibrationFile()));
    replay.Estimate(recording, [&](const force_estimation::ForceEstimate& estimate) {
      if (recording.steady_window_s && !recording.steady_window_s->Contains(estimate.t_s)) return;
      const auto of_frame = ErrorsOf(estimate, recording);
      if (of_frame) errors.emplace(std::pair(recording.name, estimate.t_s), *of_frame);
    });
  }
  return errors;
}

/// RMS of the frames that both have.
diagnosis::ForceError Compare(const ForceErrors& before, const ForceErrors& after) {
  diagnosis::ForceError error;
  double before_N2 = 0.0;
  double after_N2 = 0.0;
  std::string last;
  for (const auto& [frame, before_N] : before) {
    const auto same = after.find(frame);
    if (same == after.end() || before_N.size() == 0) continue;
    before_N2 += before_N.squaredNorm();
    after_N2 += same->second.squaredNorm();
    error.forces += static_cast<int>(before_N.size());
    error.recordings += frame.first != last ? 1 : 0;
    last = frame.first;
  }
  if (error.forces == 0) return error;
  error.before_N = std::sqrt(before_N2 / error.forces);
  error.after_N = std::sqrt(after_N2 / error.forces);
  return error;
}

}  // namespace

diagnosis::ForceError MeasureForceError(const robot::RobotDescription& robot,
                                        const diagnosis::Diagnosis& diagnosis,
                                        const experiment::Experiment& experiment,
                                        const std::function<bool()>& stop_requested) {
  const bool in_files = diagnosis.not_in_files.size() < diagnosis.result.causes.size();
  if (!in_files ||
      std::none_of(experiment.recordings.begin(), experiment.recordings.end(), HasKnownForces)) {
    return {};
  }
  try {
    return Compare(Estimate(robot, std::nullopt, experiment, stop_requested),
                   Estimate(diagnosis.extended, diagnosis.calibration, experiment, stop_requested));
  } catch (const InputError& error) {
    diagnosis::ForceError unknown;
    unknown.why_not = error.what();
    return unknown;
  }
}

}  // namespace palpate::command
