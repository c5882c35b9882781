// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/worker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>
#include <thread>
#include <vector>

namespace palpate {
namespace {

using Squarer = Worker<int, int>;

/// Counts results, and waits for them.
class Bell {
 public:
  void Ring() { rings_.release(); }
  void Await() { rings_.acquire(); }

 private:
  std::counting_semaphore<> rings_{0};
};

TEST(Worker, WorksInAnotherThreadOnOneJobAtATime) {
  Bell bell;
  std::thread::id thread;
  Squarer worker({.run =
                      [&](int& job) {
                        thread = std::this_thread::get_id();
                        return job * job;
                      },
                  .on_result = [&] { bell.Ring(); }});
  EXPECT_FALSE(worker.busy());
  EXPECT_FALSE(worker.TakeResult());
  for (const int job : {3, 4}) {
    worker.Start(job);
    EXPECT_TRUE(worker.busy());
    bell.Await();
    EXPECT_TRUE(worker.busy()) << "until the result is taken";
    EXPECT_EQ(worker.TakeResult(), job * job);
    EXPECT_FALSE(worker.busy());
  }
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST(Worker, TheNewestJobOvertakesThoseThatMayBe) {
  Bell bell;
  std::binary_semaphore begun{0}, go{0};
  Squarer worker({.run =
                      [&](int& job) {
                        begun.release();
                        go.acquire();
                        return job;
                      },
                  .on_result = [&] { bell.Ring(); }},
                 {.jobs = 8, .results = 8});
  worker.Push(1, true);
  begun.acquire();
  for (const int job : {2, 3}) worker.Push(job, true);
  worker.Push(4, false);
  worker.Push(5, true);
  std::vector<int> results;
  for (int k = 0; k < 3; ++k) {
    go.release();
    bell.Await();
    results.push_back(worker.TakeResult().value());
    if (k < 2) begun.acquire();
  }
  EXPECT_EQ(results, (std::vector<int>{1, 4, 5}));
  EXPECT_EQ(worker.dropped(), 2u);
}

TEST(Worker, GivesTheResultOutBeforeWhatCanWait) {
  Bell bell, done;
  std::atomic<bool> taken = false;
  bool taken_before = false;
  std::binary_semaphore out{0};
  Squarer worker({.run = [](int& job) { return ++job; },
                  .on_result = [&] { bell.Ring(); },
                  .afterwards =
                      [&](const int& job) {
                        out.acquire();
                        taken_before = taken && job == 2;
                        done.Ring();
                      }});
  worker.Start(1);
  bell.Await();
  EXPECT_EQ(worker.TakeResult(), 2);
  taken = true;
  out.release();
  done.Await();
  EXPECT_TRUE(taken_before);
}

TEST(Worker, EndsWithJobsThatWait) {
  std::binary_semaphore begun{0};
  std::atomic<int> worked = 0;
  {
    Squarer worker({.run =
                        [&](int& job) {
                          ++worked;
                          begun.release();
                          return job;
                        },
                    .on_result = [] {}},
                   {.jobs = 4, .results = 4});
    worker.Push(1, false);
    begun.acquire();
  }
  EXPECT_EQ(worked, 1);
}

}  // namespace
}  // namespace palpate
