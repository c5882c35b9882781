// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

/// Segmentation of a frame of 848x480 pixels on one core: four_leg at 0.45 m as in pushes.yaml, a
/// ball in view, by the predicted surface, with colours registered and of a camera of their own,
/// from nearer, without a prediction; and registration alone.
Block PerceptionBlock();

}  // namespace palpate::benchmarks
