// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/pipeline/marker_pipeline.hpp"

#include <utility>

#include "components/force_estimation/monitor/marker_motion.hpp"
#include "libs/core/index.hpp"

namespace palpate::force_estimation {

MarkerPipeline::MarkerPipeline(robot::RobotModel& model, const Config& config,
                               const robot::CalibrationFile& calibration)
    : estimator_(model, config, robot::RelativeModulusError(calibration)),
      gap_(model.body(), config.marker_sigma_m, config.marker_bias_m),
      drift_monitor_("what carries the markers") {
  for (const robot::BodyMarker& marker : model.body().markers) points_.push_back(marker.point);
  centre_m_ = MarkersOf(model.RestState().x_m).rowwise().mean();
}

const PipelineResult& MarkerPipeline::Update(PipelineFrame frame) {
  frame_ = std::get<MarkerFrame>(std::move(frame));
  result_.estimate = estimator_.Update(frame_);
  result_.gap = gap_.Measure(frame_, result_.estimate);
  const Status& status = result_.estimate.status;
  result_.state_is_known = IsUsable(status);
  result_.state = result_.state_is_known ? Status::Ok() : status;
  result_.drift = drift_monitor_.report();
  result_.gap_so_far = residual_monitor_.report();
  return result_;
}

/// Each frame counts: markers are few, and the motion that they show is uncertain by their noise
/// over the root of the number of frames.
void MarkerPipeline::Monitor() {
  if (frame_.reference != ReferenceShape::kNone) return;
  residual_monitor_.Add(frame_.t_s, result_.gap);
  drift_monitor_.Add(frame_.t_s,
                     SeeMotion(estimator_.Misfit(), MarkersOf(result_.estimate.x_m), centre_m_));
}

/// [3 x markers] of the body at `x_m` [3n], robot frame.
Eigen::Matrix3Xd MarkerPipeline::MarkersOf(const Eigen::VectorXd& x_m) const {
  Eigen::Matrix3Xd places_m(3, ToIndex(points_.size()));
  for (std::size_t m = 0; m < points_.size(); ++m) {
    places_m.col(ToIndex(m)) = points_[m].weights.Position(x_m);
  }
  return places_m;
}

}  // namespace palpate::force_estimation
