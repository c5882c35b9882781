// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/worker.hpp"

#include <utility>

namespace palpate::force_estimation {

namespace {
constexpr size_t kMostFrames = 1024;
constexpr size_t kMostResults = 128;
}  // namespace

Worker::Worker(std::unique_ptr<robot::RobotModel> model, const NodeConfig& config,
               double youngs_modulus_relative_sigma, std::function<void()> on_result)
    : model_(std::move(model)),
      config_(config),
      modulus_sigma_(youngs_modulus_relative_sigma),
      on_result_(std::move(on_result)),
      gap_meter_(model_->body(), config.marker_sigma_m, config.marker_bias_m),
      frames_(kMostFrames),
      results_(kMostResults) {
  MakeEstimator();
  thread_ = std::thread([this] { Run(); });
}

Worker::~Worker() {
  frames_.Stop();
  thread_.join();
}

void Worker::Push(FrameInput input) {
  const bool overtakable = input.frame.reference == ReferenceShape::kNone && !input.new_sequence;
  frames_.Push(std::move(input), overtakable);
}

void Worker::Run() {
  while (const std::optional<FrameInput> input = frames_.Pop()) {
    if (input->new_sequence) MakeEstimator();
    const ForceEstimate& estimate = estimator_->Update(input->frame);
    results_.Push({input->head, estimate, gap_meter_.Measure(input->frame, estimate)}, false);
    on_result_();
  }
}

void Worker::MakeEstimator() {
  estimator_ = std::make_unique<MarkerForceEstimator>(*model_, config_, modulus_sigma_);
}

}  // namespace palpate::force_estimation
