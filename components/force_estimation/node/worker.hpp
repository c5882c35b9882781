// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "components/force_estimation/node/frame_estimator.hpp"
#include "components/force_estimation/node/frame_input.hpp"
#include "libs/core/bounded_queue.hpp"

namespace palpate::force_estimation {

/// Runs the estimator in a thread of its own. Frames wait in a bounded queue in which a newer frame
/// overtakes older ones, except those with a reference shape.
class Worker {
 public:
  /// `on_result` is called from that thread when a result waits. Throws what `maker` throws.
  Worker(std::unique_ptr<robot::RobotModel> model, FrameEstimatorMaker maker,
         std::function<void()> on_result);
  ~Worker();

  const robot::RobotModel& model() const { return *model_; }
  void Push(FrameInput input);
  std::optional<FrameResult> TakeResult() { return results_.TryPop(); }
  uint64_t dropped() const { return frames_.dropped() + results_.dropped(); }

 private:
  void Run();
  void Adopt(const NewCalibration& found);

  std::unique_ptr<robot::RobotModel> model_;
  FrameEstimatorMaker maker_;
  std::function<void()> on_result_;
  std::unique_ptr<FrameEstimator> estimator_;
  BoundedQueue<FrameInput> frames_;
  BoundedQueue<FrameResult> results_;
  std::thread thread_;
};

}  // namespace palpate::force_estimation
