// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/worker.hpp"

#include <utility>

namespace palpate::force_estimation {

namespace {
constexpr size_t kMostFrames = 1024;
constexpr size_t kMostResults = 128;
}  // namespace

Worker::Worker(std::unique_ptr<robot::RobotModel> model, PipelineMaker maker,
               std::function<void()> on_result)
    : model_(std::move(model)),
      maker_(std::move(maker)),
      pipeline_(maker_(*model_)),
      worker_({.run = [this](FrameInput& input) { return Estimate(input); },
               .on_result = std::move(on_result),
               .afterwards =
                   [this](const FrameInput& input) {
                     if (input.posture_only) return;
                     pipeline_->PrepareNext();
                     pipeline_->Monitor();
                   }},
              {.jobs = kMostFrames, .results = kMostResults}) {}

void Worker::Push(FrameInput input) {
  const bool overtakable = input.overtakable();
  worker_.Push(std::move(input), overtakable);
}

FrameResult Worker::Estimate(FrameInput& input) {
  if (input.calibration) Adopt(*input.calibration);
  if (input.posture_only) return ExpectPosture(input);
  if (input.new_sequence) {
    pipeline_ = maker_(*model_);
    if (posture_m_.size() > 0) pipeline_->Expect(posture_m_);
  }
  posture_m_.resize(0);  // cables of later sequences may be pulled otherwise
  return {pipeline_->Update(std::move(input.frame)), input.head};
}

/// The equilibrium under the cable inputs, solved again only where these have changed.
FrameResult Worker::ExpectPosture(FrameInput& input) {
  FrameResult result;
  result.head = input.head;
  result.posture_only = true;
  if (posture_m_.size() == 0 || input.cables() != posture_cables_) {
    posture_m_.resize(0);
    posture_cables_ = input.cables();
    fem::StaticState state = model_->RestState();
    result.state = model_->Solve(posture_cables_, {}, &state).status;
    if (!result.state.ok()) return result;
    posture_m_ = state.x_m;
    pipeline_->Expect(posture_m_);
  }
  result.state = Status::Ok();
  result.state_is_known = true;
  result.estimate.x_m = posture_m_;
  return result;
}

void Worker::Adopt(const NewCalibration& change) {
  robot::ApplyCalibration(change.calibration, model_.get());
  posture_m_.resize(0);
  if (change.maker) maker_ = change.maker;
}

}  // namespace palpate::force_estimation
