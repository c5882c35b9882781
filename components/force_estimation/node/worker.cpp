// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/worker.hpp"

#include <utility>

namespace palpate::force_estimation {

namespace {
constexpr size_t kMostFrames = 1024;
constexpr size_t kMostResults = 128;
}  // namespace

Worker::Worker(std::unique_ptr<robot::RobotModel> model, FrameEstimatorMaker maker,
               std::function<void()> on_result)
    : model_(std::move(model)),
      maker_(std::move(maker)),
      on_result_(std::move(on_result)),
      estimator_(maker_(*model_)),
      frames_(kMostFrames),
      results_(kMostResults) {
  thread_ = std::thread([this] { Run(); });
}

Worker::~Worker() {
  frames_.Stop();
  thread_.join();
}

void Worker::Push(FrameInput input) {
  const bool overtakable = input.overtakable();
  frames_.Push(std::move(input), overtakable);
}

void Worker::Run() {
  while (std::optional<FrameInput> input = frames_.Pop()) {
    if (input->calibration) Adopt(*input->calibration);
    if (input->new_sequence) estimator_ = maker_(*model_);
    results_.Push(estimator_->Update(*input), false);
    on_result_();
    estimator_->AfterUpdate(*input);
  }
}

void Worker::Adopt(const NewCalibration& found) {
  robot::ApplyCalibration(found.calibration, model_.get());
  if (found.maker) maker_ = found.maker;
}

}  // namespace palpate::force_estimation
