// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/marker_replay.hpp"

#include <Eigen/Core>
#include <utility>

#include "components/force_estimation/pipeline/marker_pipeline.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/palpate/progress_line.hpp"

namespace palpate::command {

void MarkerReplay::Estimate(const experiment::Recording& recording,
                            const TakeEstimate& take) const {
  robot::RobotModel& model = *inputs_.model;
  const Eigen::Vector3d gravity_m_s2 = model.gravity_m_s2();
  model.SetGravity(experiment::BaseRotation(recording).transpose() * gravity_m_s2);
  force_estimation::MarkerPipeline pipeline(model, config_, calibration_);
  auto frames = force_estimation::FramesOfRecording(inputs_.experiment, recording, model,
                                                    inputs_.cable_input);
  ProgressLine progress("frames", static_cast<int>(frames.size()));
  int done = 0;
  for (force_estimation::MarkerFrame& frame : frames) {
    take(pipeline.Update(std::move(frame)).estimate);
    progress.Update(++done);
  }
  model.SetGravity(gravity_m_s2);
}

}  // namespace palpate::command
