// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>

namespace palpate::test_support {

/// While it lives the program gets no more than `more_bytes` of address space besides what it has:
/// a reader that believes the sizes in a small file fails with std::bad_alloc. Sanitizers reserve
/// terabytes, and have no limit.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::size_t more_bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + more_bytes;
    setrlimit(RLIMIT_AS, &limit);
    is_set_ = true;
#else
    static_cast<void>(more_bytes);
#endif
  }
  ~MemoryLimit() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
  bool is_set_ = false;
};

/// For readers of files of some kilobytes: LZMA's decoder alone takes up to 128 MiB.
inline constexpr std::size_t kReaderLimit_bytes = std::size_t{256} << 20;

}  // namespace palpate::test_support
