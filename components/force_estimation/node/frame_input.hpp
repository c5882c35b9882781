// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/node/model_gap.hpp"

namespace palpate::force_estimation {

/// Which marker frame something belongs to.
struct FrameHead {
  int64_t stamp_ns = 0;
  uint64_t counter = 0;
  std::string recording;
  std::chrono::steady_clock::time_point taken;  ///< when it was taken from DDS
};

/// A marker frame on its way to the estimator.
struct FrameInput {
  FrameHead head;
  bool new_sequence = false;  ///< what was learnt from earlier frames is void
  MarkerFrame frame;
};

/// What came of it.
struct FrameResult {
  FrameHead head;
  ForceEstimate estimate;
  ModelGapReport gap;
};

}  // namespace palpate::force_estimation
