// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace palpate {

/// Threads that work together on sections of some microseconds to milliseconds. They wait for the
/// next section by looking again and again for a while before they sleep, so that a section costs
/// less than a microsecond to start while frames come. A part of a section that its thread has not
/// begun when the caller has done its own is taken over by the caller. A thread whose core is busy
/// then holds nobody up unless it is in the middle of its part; after such a wait the caller works
/// alone for so long that waits take a twentieth of the time. Nothing is allocated after
/// construction.
class ThreadTeam {
 public:
  /// `size` >= 1 threads in all; the caller of Run is one of them.
  explicit ThreadTeam(int size);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int Size() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(index) once for every index 0 .. Size() - 1, 0 on the caller and the others on
  /// threads of their own where these are awake, and returns when all are done. No part may wait
  /// for another. `work` must not throw. One section at a time, from one thread.
  template <typename Work>
  void Run(const Work& work) {
    if (workers_.empty()) {
      work(0);
      return;
    }
    RunErased([](const void* context, int index) { (*static_cast<const Work*>(context))(index); },
              &work);
  }

 private:
  using Function = void (*)(const void* context, int index);
  /// The last section in which an index was begun.
  struct alignas(64) Begun {
    std::atomic<unsigned> section{0};
  };

  void RunErased(Function function, const void* context);
  void Work(int index);
  /// Whether the index was not begun before in this section, the present one.
  bool Begin(int index, unsigned section);

  std::vector<std::thread> workers_;
  std::vector<Begun> begun_;  ///< [Size()]
  Function function_ = nullptr;
  const void* context_ = nullptr;
  alignas(64) std::atomic<unsigned> section_{0};  ///< counts the sections that were started
  alignas(64) std::atomic<int> running_{0};       ///< parts that are not finished
  std::atomic<bool> stop_{false};
  std::chrono::steady_clock::time_point alone_until_;
};

}  // namespace palpate
