// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>

#include "components/force_estimation/node/frame_input.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/gap_counter.hpp"

namespace palpate::force_estimation {

/// Checks the order and the age of marker frames.
class FrameGate {
 public:
  enum class Verdict {
    kNext,
    kRepeated,      ///< the last frame once more: its answer was lost
    kNewSequence,   ///< the first of a sequence that begins after the last one's end
    kTimeWentBack,  ///< the first of a sequence that begins before the last one's end
    kStale,         ///< not newer than the last frame
  };

  Verdict Judge(const FrameHead& head);

  /// kStale where `head` is older than `max_age_s` at `now_ns`; 0: no limit.
  static Status CheckAge(const FrameHead& head, int64_t now_ns, double max_age_s);

  uint64_t lost() const { return gaps_.lost(); }

 private:
  dds::GapCounter gaps_;
  std::optional<FrameHead> last_;
};

}  // namespace palpate::force_estimation
