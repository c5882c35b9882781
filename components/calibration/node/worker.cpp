// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/worker.hpp"

#include <utility>

#include "libs/core/check.hpp"

namespace palpate::calibration {

Worker::Worker(std::unique_ptr<robot::RobotModel> model, Fit fit, std::function<void()> on_result)
    : model_(std::move(model)),
      fit_(std::move(fit)),
      on_result_(std::move(on_result)),
      jobs_(1),
      results_(1) {
  thread_ = std::thread([this] { Run(); });
}

Worker::~Worker() {
  StopFit();
  jobs_.Stop();
  thread_.join();
}

void Worker::Start(LiveJob job) {
  PALPATE_CHECK(!busy_);
  busy_ = true;
  stop_ = std::stop_source();
  job.request.stop = stop_.get_token();
  jobs_.Push(std::move(job), false);
}

std::optional<LiveResult> Worker::TakeResult() {
  std::optional<LiveResult> result = results_.TryPop();
  if (result) busy_ = false;
  return result;
}

void Worker::Run() {
  while (const std::optional<LiveJob> job = jobs_.Pop()) {
    results_.Push(fit_(*model_, *job), false);
    on_result_();
  }
}

}  // namespace palpate::calibration
