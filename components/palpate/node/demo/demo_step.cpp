// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/demo_step.hpp"

#include <fmt/core.h>

#include <cstdio>

#include "libs/core/clock.hpp"

namespace palpate::command {

DemoStep::DemoStep(const std::string& what) : start_ns_(MonotonicNow_ns()) {
  fmt::print("\n{}\n", what);
  std::fflush(stdout);
}

DemoStep::~DemoStep() {
  fmt::print("  ({:.1f} s)\n", static_cast<double>(MonotonicNow_ns() - start_ns_) * 1e-9);
  std::fflush(stdout);
}

}  // namespace palpate::command
