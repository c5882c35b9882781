// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/time_budget.hpp"

#include <chrono>

#include "libs/core/seconds.hpp"

namespace palpate::fem {

double SteadySeconds() { return ToSeconds(std::chrono::steady_clock::now().time_since_epoch()); }

}  // namespace palpate::fem
