// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/worker.hpp"

#include <utility>

namespace palpate::calibration {

Worker::Worker(std::unique_ptr<robot::RobotModel> model, Fit fit, std::function<void()> on_result)
    : model_(std::move(model)),
      worker_({.run = [this, fit = std::move(fit)](LiveJob& job) { return fit(*model_, job); },
               .on_result = std::move(on_result)}) {}

Worker::~Worker() { StopFit(); }

void Worker::Start(LiveJob job) {
  stop_ = std::stop_source();
  job.request.stop = stop_.get_token();
  worker_.Start(std::move(job));
}

}  // namespace palpate::calibration
