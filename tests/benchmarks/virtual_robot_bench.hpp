// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

/// One frame of 1/30 s of the virtual robot on one core: four_leg with two cables moving, while a
/// ball with friction is pressed into the hub and taken away; bodies of three kinds, quasi-static
/// and dynamic.
Block VirtualRobotBlock();

}  // namespace palpate::benchmarks
