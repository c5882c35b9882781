// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

/// Joint calibration of four_leg from its nine markers with 0.3 mm of noise: camera pose and cable
/// tensions of one frame, and camera pose, offsets of the actuators and Young's moduli of three
/// parts from ten. Each calibration is a whole one, from a start that knows nothing of the pose.
Block CalibrationBlock();

}  // namespace palpate::benchmarks
