// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "components/perception/node/convert.hpp"
#include "components/perception/node/frame_pairing.hpp"
#include "components/perception/node/frame_perception.hpp"
#include "components/perception/node/prediction_history.hpp"
#include "libs/core/bounded_queue.hpp"

namespace palpate::perception {

/// A frame on its way to perception.
struct PerceptionJob {
  FrameOutcome outcome;  ///< all but the observation
  rgbd::RgbdFrame images;
  std::optional<Prediction> prediction;
  std::optional<Config> reset;             ///< the colour model of earlier frames is void
  std::optional<rgbd::RgbdCamera> camera;  ///< another one than before, or reopened
  FrameSet::Time taken;
};

/// What came of it.
struct PerceptionResult {
  FrameOutcome outcome;
  FrameSet::Time taken;
};

/// Runs perception in a thread of its own, one frame at a time.
class Worker {
 public:
  /// `on_result` is called from that thread when a result waits. Throws InputError for settings
  /// that do not go together.
  Worker(const Config& config, FramePerceptionMaker maker, std::function<void()> on_result);
  ~Worker();

  /// Only when nothing is in work.
  void Start(PerceptionJob job);
  std::optional<PerceptionResult> TakeResult();
  bool busy() const { return busy_; }

 private:
  void Run();
  PerceptionResult Perceive(PerceptionJob& job);

  FramePerceptionMaker maker_;
  std::function<void()> on_result_;
  std::unique_ptr<FramePerception> perception_;
  BoundedQueue<PerceptionJob> jobs_{1};
  BoundedQueue<PerceptionResult> results_{1};
  bool busy_ = false;  ///< between Start() and TakeResult()
  std::thread thread_;
};

}  // namespace palpate::perception
