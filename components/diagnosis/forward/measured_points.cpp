// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/measured_points.hpp"

#include <cmath>
#include <limits>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

template <typename Law>
double MeanOverFrames(const ObservedExperiment& observed, const Sample& sample, const Law& law) {
  double sum = 0.0;
  for (const double t_s : sample.frame_t_s) sum += law(t_s - observed.timeline.begin_s.front());
  return sum / static_cast<double>(sample.frame_t_s.size());
}

}  // namespace

std::optional<CameraView> ViewOf(const CameraErrors& errors, const ObservedExperiment& observed,
                                 const Sample& sample, Target target) {
  const auto& recording = observed.recordings[At(sample.recording)];
  const bool seen =
      target == Target::kSurface ? recording.T_camera_robot.has_value() : recording.by_depth_camera;
  if (!seen || sample.frame_t_s.empty()) return std::nullopt;
  double drift_m = 0.0;
  for (const DepthDrift& drift : errors.drifts) {
    drift_m += drift.amplitude_m * DriftShare(observed, sample, drift.tau_s);
  }
  const Eigen::Vector2d unknown_px =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  return CameraView(errors, recording.focal_px.value_or(unknown_px), drift_m);
}

double DriftShare(const ObservedExperiment& observed, const Sample& sample, double tau_s) {
  return MeanOverFrames(observed, sample,
                        [tau_s](double t_s) { return 1.0 - std::exp(-t_s / tau_s); });
}

double DriftShareByTau(const ObservedExperiment& observed, const Sample& sample, double tau_s) {
  return MeanOverFrames(observed, sample,
                        [tau_s](double t_s) { return -t_s / tau_s * std::exp(-t_s / tau_s); });
}

}  // namespace palpate::diagnosis
