// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/worker.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

constexpr std::chrono::seconds kLong(20);  ///< nothing is asserted of it

/// Shared between a pipeline and the thread that takes its results.
struct Exchange {
  std::mutex mutex;
  std::condition_variable changed;
  bool came = false;
  bool taken = false;
  std::optional<bool> taken_before;  ///< whether the result was out when PrepareNext was called
};

class Watching : public Pipeline {
 public:
  explicit Watching(Exchange& exchange) : exchange_(exchange) {}
  const PipelineResult& Update(PipelineFrame) override { return result_; }
  void PrepareNext() override {
    std::unique_lock lock(exchange_.mutex);
    exchange_.taken_before =
        exchange_.changed.wait_for(lock, kLong, [this] { return exchange_.taken; });
    exchange_.changed.notify_all();
  }

 private:
  Exchange& exchange_;
  PipelineResult result_;
};

TEST(Worker, GivesTheResultOutBeforeWhatCanWait) {
  Exchange exchange;
  Worker worker(
      Build(BeamRobot()), [&](robot::RobotModel&) { return std::make_unique<Watching>(exchange); },
      [&] {
        const std::lock_guard lock(exchange.mutex);
        exchange.came = true;
        exchange.changed.notify_all();
      });
  worker.Push(FrameInput{});
  std::unique_lock lock(exchange.mutex);
  ASSERT_TRUE(exchange.changed.wait_for(lock, kLong, [&] { return exchange.came; }));
  EXPECT_TRUE(worker.TakeResult());
  exchange.taken = true;
  exchange.changed.notify_all();
  ASSERT_TRUE(
      exchange.changed.wait_for(lock, kLong, [&] { return exchange.taken_before.has_value(); }));
  EXPECT_TRUE(*exchange.taken_before);
}

}  // namespace
}  // namespace palpate::force_estimation
