// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

namespace palpate::command {

/// Prints the name of a step, and afterwards its duration.
class DemoStep {
 public:
  explicit DemoStep(const std::string& what);
  ~DemoStep();
  DemoStep(const DemoStep&) = delete;
  DemoStep& operator=(const DemoStep&) = delete;

 private:
  std::int64_t start_ns_;
};

}  // namespace palpate::command
