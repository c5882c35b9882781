// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cholmod.h>

#include <cstddef>

namespace palpate::fem::internal {

/// While it lives, this thread's CHOLMOD takes blocks that were freed inside such a scope, and no
/// others. Solving keeps its workspace between calls; without this it would hold on to blocks that
/// the next factorisation counts on.
class SolveMemoryScope {
 public:
  SolveMemoryScope();
  ~SolveMemoryScope();
  SolveMemoryScope(const SolveMemoryScope&) = delete;
  SolveMemoryScope& operator=(const SolveMemoryScope&) = delete;
};

/// A CHOLMOD workspace whose memory comes from a pool that keeps freed blocks for the next
/// factorisation, with one BLAS thread and no output. Not shared between threads.
class CholmodContext {
 public:
  CholmodContext();
  ~CholmodContext();
  CholmodContext(const CholmodContext&) = delete;
  CholmodContext& operator=(const CholmodContext&) = delete;

  cholmod_common* get() { return &common_; }
  size_t memory_inuse() const { return common_.memory_inuse; }

 private:
  cholmod_common common_;
};

/// While it lives, OpenMP loops that this thread enters run on this thread alone. CHOLMOD enters
/// some thousand loops of a few dozen iterations in one factorisation, on four threads each:
/// handing them out takes longer than running them.
class OneThread {
 public:
  OneThread();
  ~OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_before_ = -1;
};

}  // namespace palpate::fem::internal
