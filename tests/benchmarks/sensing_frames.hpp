// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <vector>

#include "tests/benchmarks/block.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/benchmarks/sensing_sets.hpp"

namespace palpate::benchmarks {

using SharedSets = std::shared_ptr<Lazy<SensingSets>>;

/// What a frame costs ShapeForceEstimator on four_leg, with ideal perception:
///   sensing/estimate_N_points     a contact coming, held and going, a frame each time
///   sensing/frame_costs           counters, over four contacts: processor time in ms (median,
///   mean)
///                                 and linearisations of frames in which a contact is held, one
///                                 comes or goes, and one jumps from nothing to its whole force
///                                 (until the first estimate); and with a contact held and as few
///                                 feature points as forces can be estimated from (12: six must be
///                                 matched)
std::vector<Block> FrameBlocks(const SharedSets& sets);

}  // namespace palpate::benchmarks
