// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/worker.hpp"

#include <utility>

#include "libs/core/check.hpp"

namespace palpate::perception {

Worker::Worker(const Config& config, FramePerceptionMaker maker, std::function<void()> on_result)
    : maker_{std::move(maker)}, on_result_{std::move(on_result)}, perception_{maker_(config)} {
  thread_ = std::thread([this] { Run(); });
}

Worker::~Worker() {
  jobs_.Stop();
  thread_.join();
}

void Worker::Start(PerceptionJob job) {
  PALPATE_CHECK(!busy_, job.outcome.stamp_ns);
  busy_ = true;
  jobs_.Push(std::move(job), false);
}

std::optional<PerceptionResult> Worker::TakeResult() {
  std::optional<PerceptionResult> result = results_.TryPop();
  if (result) busy_ = false;
  return result;
}

void Worker::Run() {
  while (std::optional<PerceptionJob> job = jobs_.Pop()) {
    results_.Push(Perceive(*job), false);
    on_result_();
  }
}

PerceptionResult Worker::Perceive(PerceptionJob& job) {
  if (job.reset) perception_ = maker_(*job.reset);
  if (job.camera) perception_->SetCamera(*job.camera);
  const PredictedSurface* predicted = job.prediction ? &job.prediction->surface : nullptr;
  job.outcome.observation = perception_->Update(job.images, predicted);
  return {std::move(job.outcome), job.taken};
}

}  // namespace palpate::perception
