// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "tests/support/sensing/accuracy.hpp"
#include "tests/support/sensing/sensing_chain.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {

/// How long contacts are watched, in frames.
struct WatchPlan {
  int settle = 5;    ///< after the last movement, before it counts
  int measured = 5;  ///< that count
  int rest = 5;      ///< after the tools have gone
};

struct Watched {
  Accuracy held;           ///< the frames that count
  Accuracy underway{1e9};  ///< all others, for false alarms and failures: no force counts
  /// [paths] smallest true force from which on the estimate always had one, N; infinite: never.
  std::vector<double> found_from_N;
};

/// Shows the chain a path of states (ContactGenerator::path), a frame each, then its end for a
/// while, then the way back twice as fast.
void Watch(const std::vector<SceneState>& path, const WatchPlan& plan, SensingScene& scene,
           SensingChain& chain, Watched* watched);

}  // namespace palpate::test_support
