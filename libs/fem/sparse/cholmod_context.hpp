// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cholmod.h>

#include <cstddef>

namespace palpate::fem::internal {

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

}  // namespace palpate::fem::internal
