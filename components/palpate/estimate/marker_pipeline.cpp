// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/marker_pipeline.hpp"

#include <utility>

#include "components/force_estimation/recording_frames.hpp"
#include "components/palpate/progress_line.hpp"

namespace palpate::command {

MarkerPipeline::MarkerPipeline(force_estimation::Config config, robot::CableInput cable_input,
                               const experiment::Experiment& experiment, robot::RobotModel* model,
                               double modulus_error)
    : config_(std::move(config)),
      cable_input_(cable_input),
      experiment_(experiment),
      model_(*model),
      gravity_m_s2_(model->gravity_m_s2()),
      modulus_error_(modulus_error) {}

void MarkerPipeline::Estimate(const experiment::Recording& recording, const TakeEstimate& take) {
  model_.SetGravity(experiment::BaseRotation(recording).transpose() * gravity_m_s2_);
  force_estimation::MarkerForceEstimator estimator(model_, config_, modulus_error_);
  const auto frames =
      force_estimation::FramesOfRecording(experiment_, recording, model_, cable_input_);
  ProgressLine progress("frames", static_cast<int>(frames.size()));
  int done = 0;
  for (const force_estimation::MarkerFrame& frame : frames) {
    take(estimator.Update(frame));
    progress.Update(++done);
  }
  model_.SetGravity(gravity_m_s2_);
}

}  // namespace palpate::command
