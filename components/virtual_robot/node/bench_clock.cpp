// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/bench_clock.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"

namespace palpate::virtual_robot {

BenchClock::BenchClock(double period_s, double max_step_s)
    : period_s_{period_s}, max_step_s_{std::max(max_step_s, period_s)} {
  PALPATE_CHECK(period_s > 0.0 && max_step_s > 0.0, period_s, max_step_s);
}

void BenchClock::Start(double now_s) {
  bench_s_ = 0.0;
  missed_ = 0;
  due_s_ = now_s + period_s_;
}

double BenchClock::Tick(double now_s) {
  PALPATE_CHECK(now_s >= due_s_, now_s, due_s_);
  const double late = std::floor((now_s - due_s_) / period_s_);
  const double most = std::max(0.0, std::floor(max_step_s_ / period_s_ + 1e-9) - 1.0);
  bench_s_ += (1.0 + std::min(late, most)) * period_s_;
  missed_ += static_cast<std::uint64_t>(late);
  due_s_ += (1.0 + late) * period_s_;
  return bench_s_;
}

}  // namespace palpate::virtual_robot
