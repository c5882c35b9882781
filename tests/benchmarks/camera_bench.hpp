// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

/// The virtual camera on one core, 848x480: a whole noisy frame of depth and colour of four_leg
/// with a tool and with a hand in view, the same without noise in the depth image, and depth alone.
Block CameraBlock();

}  // namespace palpate::benchmarks
