// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

namespace palpate::command {

/// Says what happens, and afterwards how long it took.
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
