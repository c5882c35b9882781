// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "libs/core/bounded_queue.hpp"
#include "libs/core/check.hpp"

namespace palpate {

/// Turns jobs into results in a thread of its own, in the order in which they were given. All
/// methods are for the one thread that owns the worker.
template <typename Job, typename Result>
class Worker {
 public:
  struct Work {
    std::function<Result(Job&)> run;
    std::function<void()> on_result;                  ///< called when a result waits
    std::function<void(const Job&)> afterwards = {};  ///< what can wait until then; may be empty
  };
  /// How many jobs and results wait at most: of more the oldest are dropped.
  struct Limits {
    std::size_t jobs = 1;
    std::size_t results = 1;
  };

  explicit Worker(Work work) : Worker(std::move(work), Limits()) {}
  Worker(Work work, Limits limits)
      : work_(std::move(work)), jobs_(limits.jobs), results_(limits.results) {
    thread_ = std::thread([this] { Run(); });
  }
  /// Waits for the job that is in work; those that wait are dropped.
  ~Worker() {
    jobs_.Stop();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Of the jobs marked as overtakable only the newest waits.
  void Push(Job job, bool overtakable) { jobs_.Push(std::move(job), overtakable); }

  /// One job at a time: only when not busy().
  void Start(Job job) {
    PALPATE_CHECK(!busy_);
    busy_ = true;
    jobs_.Push(std::move(job), false);
  }
  /// Between Start() and the TakeResult() that has its result.
  bool busy() const { return busy_; }

  /// The oldest result, or nullopt.
  std::optional<Result> TakeResult() {
    std::optional<Result> result = results_.TryPop();
    if (result) busy_ = false;
    return result;
  }

  /// Jobs that were overtaken, and jobs and results that were pushed out.
  std::uint64_t dropped() const { return jobs_.dropped() + results_.dropped(); }

 private:
  void Run() {
    while (std::optional<Job> job = jobs_.Pop()) {
      results_.Push(work_.run(*job), false);
      work_.on_result();
      if (work_.afterwards) work_.afterwards(*job);
    }
  }

  Work work_;
  BoundedQueue<Job> jobs_;
  BoundedQueue<Result> results_;
  bool busy_ = false;
  std::thread thread_;
};

}  // namespace palpate
