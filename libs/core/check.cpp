// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace palpate::internal {

void CheckFailed(const char* condition, const char* file, int line, const std::string& values) {
  std::fprintf(stderr, "%s:%d: check failed: %s%s%s\n", file, line, condition,
               values.empty() ? "" : ", with", values.c_str());
  std::abort();
}

}  // namespace palpate::internal
