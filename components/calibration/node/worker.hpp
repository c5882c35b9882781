// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "components/calibration/live/live_calibration.hpp"
#include "libs/core/worker.hpp"

namespace palpate::calibration {

/// Runs calibrations, one at a time, in a thread of its own.
class Worker {
 public:
  using Fit = std::function<LiveResult(robot::RobotModel&, const LiveJob&)>;

  /// `on_result` is called from that thread when a result is ready.
  Worker(std::unique_ptr<robot::RobotModel> model, Fit fit, std::function<void()> on_result);
  /// Stops the running calibration.
  ~Worker();

  /// Must not be read while busy().
  const robot::RobotModel& model() const { return *model_; }
  void Start(LiveJob job);
  /// Stops the running job, if any; its result is then a failure.
  void StopFit() { stop_.request_stop(); }
  std::optional<LiveResult> TakeResult() { return worker_.TakeResult(); }
  bool busy() const { return worker_.busy(); }

 private:
  std::unique_ptr<robot::RobotModel> model_;
  std::stop_source stop_;  ///< of the running job
  palpate::Worker<LiveJob, LiveResult> worker_;
};

}  // namespace palpate::calibration
