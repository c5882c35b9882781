// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "components/force_estimation/node/frame_input.hpp"
#include "libs/core/worker.hpp"

namespace palpate::force_estimation {

/// Runs the pipeline in a thread of its own. Frames wait in a bounded queue. A newer frame replaces
/// older ones there, except those with a reference shape and those that begin a sequence. Postures
/// (FrameInput::posture_only) are to be pushed before the first frame only.
class Worker {
 public:
  /// `on_result` is called from that thread when a result waits. Throws what `maker` throws.
  Worker(std::unique_ptr<robot::RobotModel> model, PipelineMaker maker,
         std::function<void()> on_result);

  const robot::RobotModel& model() const { return *model_; }
  void Push(FrameInput input);
  std::optional<FrameResult> TakeResult() { return worker_.TakeResult(); }
  uint64_t dropped() const { return worker_.dropped(); }

 private:
  FrameResult Estimate(FrameInput& input);
  FrameResult ExpectPosture(FrameInput& input);
  void Adopt(const NewCalibration& change);

  std::unique_ptr<robot::RobotModel> model_;
  PipelineMaker maker_;
  std::unique_ptr<Pipeline> pipeline_;
  std::vector<robot::ActuatorCommand>
      posture_cables_;         ///< that posture_m_ is the equilibrium under
  Eigen::VectorXd posture_m_;  ///< [3n] empty: none
  palpate::Worker<FrameInput, FrameResult> worker_;
};

}  // namespace palpate::force_estimation
