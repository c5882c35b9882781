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
                   [this](const FrameInput&) {
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
  if (input.new_sequence) pipeline_ = maker_(*model_);
  return {pipeline_->Update(std::move(input.frame)), input.head};
}

void Worker::Adopt(const NewCalibration& change) {
  robot::ApplyCalibration(change.calibration, model_.get());
  if (change.maker) maker_ = change.maker;
}

}  // namespace palpate::force_estimation
