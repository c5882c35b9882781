// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/marker_replay.hpp"

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "components/force_estimation/pipeline/marker_pipeline.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/palpate/progress_line.hpp"

namespace palpate::command {

namespace {

using force_estimation::MarkerFrame;

/// Reference frames cost nothing, and all of them count for the marker offsets.
std::vector<MarkerFrame> Thinned(std::vector<MarkerFrame> frames, double rate_Hz) {
  std::vector<double> t_s;
  for (const MarkerFrame& frame : frames) t_s.push_back(frame.t_s);
  const std::vector<bool> kept = KeptFrames(t_s, rate_Hz);
  std::vector<MarkerFrame> thinned;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool is_reference = frames[i].reference != force_estimation::ReferenceShape::kNone;
    if (kept[i] || is_reference) thinned.push_back(std::move(frames[i]));
  }
  return thinned;
}

}  // namespace

ReplayCount MarkerReplay::Estimate(const experiment::Recording& recording,
                                   const TakeEstimate& take) const {
  robot::RobotModel& model = *inputs_.model;
  const Eigen::Vector3d gravity_m_s2 = model.gravity_m_s2();
  model.SetGravity(experiment::BaseRotation(recording).transpose() * gravity_m_s2);
  force_estimation::MarkerPipeline pipeline(model, config_, calibration_);
  auto frames = Thinned(force_estimation::FramesOfRecording(inputs_.experiment, recording, model,
                                                            inputs_.cable_input),
                        inputs_.limits.rate_Hz);
  ReplayCount count{.done = 0, .total = static_cast<int>(frames.size())};
  ProgressLine progress("frames", count.total);
  progress.SetAdvice(AdviceWhereSlow(model.body()));
  for (MarkerFrame& frame : frames) {
    if (inputs_.limits.StopRequested()) break;
    frame.loads = force_estimation::SitesOfLoads(recording.loads, frame.t_s);
    take(pipeline.Update(std::move(frame)).estimate);
    progress.Update(++count.done);
  }
  model.SetGravity(gravity_m_s2);
  return count;
}

}  // namespace palpate::command
