// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <limits>

namespace palpate {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace palpate
