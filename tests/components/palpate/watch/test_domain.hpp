// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdlib>

namespace palpate::command {

/// The domain that this test program has for itself (set by CMake).
inline int TestDomain() { return std::atoi(std::getenv("ROS_DOMAIN_ID")); }

}  // namespace palpate::command
