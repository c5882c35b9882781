// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace palpate {

/// Threads that work together on sections of some microseconds to milliseconds. They wait for the
/// next section by looking again and again for a while before they sleep, so that a section costs
/// less than a microsecond to start while frames come. Nothing is allocated after construction.
class ThreadTeam {
 public:
  /// `size` >= 1 threads in all; the caller of Run is one of them.
  explicit ThreadTeam(int size);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int Size() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(index) once on every thread, index 0 .. Size() - 1, the caller being 0, and returns
  /// when all are done. `work` must not throw. One section at a time, from one thread.
  template <typename Work>
  void Run(const Work& work) {
    if (workers_.empty()) {
      work(0);
      return;
    }
    RunErased([](const void* context, int index) { (*static_cast<const Work*>(context))(index); },
              &work);
  }

  /// Only inside a section, on every thread: returns when all threads have called it.
  void Barrier();

 private:
  using Function = void (*)(const void* context, int index);

  void RunErased(Function function, const void* context);
  void Work(int index);

  std::vector<std::thread> workers_;
  Function function_ = nullptr;
  const void* context_ = nullptr;
  alignas(64) std::atomic<unsigned> section_{0};  ///< counts the sections that were started
  alignas(64) std::atomic<int> running_{0};       ///< workers that have not finished the section
  alignas(64) std::atomic<int> arrived_{0};       ///< threads that wait at the barrier
  alignas(64) std::atomic<unsigned> barrier_{0};  ///< counts barriers that opened
  std::atomic<bool> stop_{false};
};

}  // namespace palpate
