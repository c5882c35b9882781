// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

/// Force estimation from depth images of four_leg on the virtual bench, whose physics, mesh and
/// noise the estimator does not know: the time of one frame, and the accuracy of forces in sets of
/// contacts. The figures of a set are its counters (PrintSensing).
///
/// PALPATE_SENSING_CONTACTS: single contacts of a set (10; two at once and hidden ones: half as
/// many); PALPATE_SENSING_FRAMES: contact-free frames in which false alarms are counted (300).
/// PALPATE_SENSING_SEED: of places, forces and noise (1). Throws InputError for what is no number.
std::vector<Block> SensingBlocks();

}  // namespace palpate::benchmarks
