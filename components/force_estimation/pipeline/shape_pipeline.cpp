// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/pipeline/shape_pipeline.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace palpate::force_estimation {

namespace {

struct ShapePipelineTuning {
  /// Least time between two frames of the drift monitor. Drift is slow, and a frame costs as much
  /// as a chord step of the model: a shorter time finds drift no sooner and delays the next frame.
  double drift_period_s = 0.1;
};
constexpr ShapePipelineTuning kShapePipelineTuning;

ShapePipeline::Estimator MakeEstimator(robot::RobotModel& model, const Config& config,
                                       const ShapeConfig& shape,
                                       const robot::CalibrationFile& calibration,
                                       const std::vector<std::string>& cameras) {
  const auto estimator = std::make_shared<ShapeForceEstimator>(
      model, config, shape, robot::RelativeModulusError(calibration));
  if (calibration.depth_bias) {
    estimator->TakeDepthBias(calibration.depth_bias->map, calibration.pose->T_robot_camera);
  }
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    for (const robot::CalibratedCamera& camera : calibration.cameras) {
      if (camera.name != cameras[k] || !camera.depth_bias) continue;
      estimator->TakeDepthBias(camera.depth_bias->map, camera.pose.T_robot_camera,
                               static_cast<int>(k) + 1);
    }
  }
  return {.update = [estimator](const ShapeFrame& frame) -> const ForceEstimate& {
            return estimator->Update(frame);
          },
          .features = [estimator]() -> const std::vector<FeatureReport>& {
            return estimator->features();
          },
          .prepare_next = [estimator] { estimator->PrepareNext(); },
          .judge_bias_frames = [estimator] { return estimator->JudgeBiasFrames(); }};
}

}  // namespace

ShapePipeline::ShapePipeline(robot::RobotModel& model, const Config& config,
                             const ShapeConfig& shape, const robot::CalibrationFile& calibration,
                             const std::vector<std::string>& cameras)
    : ShapePipeline(model.body(), ParseContactSites(config.contacts), shape.untouched_frames,
                    MakeEstimator(model, config, shape, calibration, cameras)) {}

ShapePipeline::ShapePipeline(const robot::RobotBody& body, std::vector<ContactSite> contacts,
                             int contact_free_frames, Estimator estimator)
    : contacts_(std::move(contacts)),
      contact_free_frames_(contact_free_frames),
      estimator_(std::move(estimator)),
      known_contacts_(body),
      gap_(body),
      fixed_region_(body),
      drift_measured_s_(-kShapePipelineTuning.drift_period_s) {}

const PipelineResult& ShapePipeline::Update(PipelineFrame frame) {
  shape_ = std::get<PerceivedShape>(std::move(frame));
  MarkContactFree();
  AddKnownContacts();
  result_.estimate = estimator_.update(shape_.frame);
  result_.gap = gap_.Measure(estimator_.features(), result_.estimate.status);
  PredictShape();
  KeepReasonOfPerception();
  result_.drift = WorstDrift();
  result_.gap_so_far = residual_monitor_.report();
  return result_;
}

void ShapePipeline::MarkContactFree() {
  result_.bias_frames_to_come = std::max(0, contact_free_frames_ - frames_with_robot_);
  if (result_.bias_frames_to_come > 0) shape_.frame.untouched = true;
  if (shape_.perception.ok()) ++frames_with_robot_;
}

void ShapePipeline::AddKnownContacts() {
  const std::vector<ContactSite>& sites = contacts_.empty() ? shape_.loads : contacts_;
  shape_.frame.contacts =
      KnownBeforeSeen(known_contacts_.At(sites, nodes_m_), shape_.frame.contacts);
}

void ShapePipeline::PredictShape() {
  const ForceEstimate& estimate = result_.estimate;
  result_.state_is_known = PredictsShape(estimate);
  if (result_.state_is_known) nodes_m_ = estimate.x_m.cast<float>().cast<double>();
  // Without a depth bias there are no forces, but the model is where the robot is.
  const bool holds =
      IsUsable(estimate.status) || estimate.status.code() == StatusCode::kNoCalibration;
  result_.state = result_.state_is_known && holds ? Status::Ok() : estimate.status;
}

void ShapePipeline::KeepReasonOfPerception() {
  Status& status = result_.estimate.status;
  const bool not_seen = status.code() == StatusCode::kNoRobotSeen;
  if (not_seen && !shape_.perception.ok()) status = shape_.perception;
}

void ShapePipeline::Monitor() {
  const ShapeFrame& frame = shape_.frame;
  residual_monitor_.Add(frame.t_s, result_.gap);
  const double since_s = frame.t_s - drift_measured_s_;
  if (since_s >= 0.0 && since_s < kShapePipelineTuning.drift_period_s) return;
  drift_measured_s_ = frame.t_s;
  drift_monitors_.resize(std::max(drift_monitors_.size(), frame.views.size()));
  for (std::size_t k = 0; k < frame.views.size(); ++k) {
    const ShapeView& view = frame.views[k];
    drift_monitors_[k].Add(frame.t_s,
                           SeeMotion(fixed_region_, view.cloud, view.T_robot_camera, nodes_m_));
  }
}

/// Of the first camera that has moved, else of the first.
DriftReport ShapePipeline::WorstDrift() const {
  if (drift_monitors_.empty()) return {};
  for (std::size_t k = 0; k < drift_monitors_.size(); ++k) {
    DriftReport report = drift_monitors_[k].report();
    report.camera = static_cast<int>(k);
    if (report.state == DriftReport::State::kMoved) return report;
  }
  return drift_monitors_.front().report();
}

Eigen::Matrix3Xf ShapePipeline::PredictedNodes_m() const {
  return Eigen::Map<const Eigen::Matrix3Xd>(nodes_m_.data(), 3, nodes_m_.size() / 3).cast<float>();
}

}  // namespace palpate::force_estimation
