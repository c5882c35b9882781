// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/shape_stream.hpp"

#include <utility>

#include "components/perception/predicted_surface.hpp"
#include "libs/core/check.hpp"

namespace palpate::offline {

ShapeStream::ShapeStream(const robot::RobotBody& body, ReplayPerception perception,
                         std::unique_ptr<force_estimation::ShapePipeline> pipeline)
    : perception_(std::move(perception)),
      pipeline_(std::move(pipeline)),
      triangles_(body.boundary.DrawnTriangles()) {}

void ShapeStream::Open(const std::vector<std::optional<rgbd::RgbdCamera>>& cameras,
                       const force_estimation::CameraPoses& poses) {
  PALPATE_CHECK(cameras.size() == poses.size(), cameras.size(), poses.size());
  perception_.open(cameras);
  ++epoch_;
  poses_ = poses;
  predicted_.resize(poses.size());
  observation_ = nullptr;
}

const perception::JointObservation& ShapeStream::Perceive(
    std::int64_t t_ns, const std::vector<const rgbd::RgbdFrame*>& images) {
  const Eigen::Matrix3Xf nodes_m = pipeline_->PredictedNodes_m();
  std::vector<perception::CameraFrame> frames(poses_.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].T_robot_camera = poses_[k];
    if (images[k] == nullptr) continue;
    frames[k].images = images[k];
    if (nodes_m.cols() == 0) continue;
    predicted_[k] = perception::MakePredictedSurface(nodes_m, triangles_, poses_[k]);
    frames[k].predicted = &predicted_[k];
  }
  observation_ = &perception_.update(t_ns, frames);
  return *observation_;
}

const force_estimation::ForceEstimate& ShapeStream::Estimate(FrameInputs inputs) {
  PALPATE_CHECK(observation_ != nullptr, epoch_);
  force_estimation::PerceivedShape shape;
  shape.frame = MakeShapeFrame(*observation_, poses_);
  shape.frame.t_s = FrameTime_s(observation_->stamp_ns);
  shape.frame.cables = std::move(inputs.cables);
  shape.frame.epoch = epoch_;
  shape.frame.untouched = inputs.contact_free;
  shape.perception = observation_->status();
  shape.loads = std::move(inputs.loads);
  const force_estimation::ForceEstimate& estimate = pipeline_->Update(std::move(shape)).estimate;
  pipeline_->PrepareNext();
  return estimate;
}

force_estimation::ShapeFrame MakeShapeFrame(const perception::JointObservation& observation,
                                            const force_estimation::CameraPoses& poses) {
  force_estimation::ShapeFrame frame;
  frame.views.clear();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const perception::CameraView& view = observation.views[k];
    frame.views.push_back({view.frame.robot, poses[k], view.texture});
  }
  for (const perception::DetectedContact& contact : observation.contacts) {
    frame.contacts.push_back(
        force_estimation::InRobotFrame({contact.name, contact.position_m, contact.covariance_m2,
                                        contact.extent_m, contact.point_count},
                                       poses.front()));
  }
  return frame;
}

}  // namespace palpate::offline
