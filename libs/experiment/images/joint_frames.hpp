// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpate::experiment {

struct JointFramesTuning {
  /// Largest time between frames of two cameras that belong together, as a share of the shortest
  /// period of a camera, and at most. Larger: frames of a moving robot are joined that show two
  /// shapes; smaller: cameras that are not triggered together are seldom joined.
  double share_of_period = 0.5;
  double longest_apart_s = 0.05;
};

/// Frames of several cameras at one time.
struct JointFrame {
  std::int64_t t_ns = 0;                           ///< of the first of the cameras that have one
  std::vector<std::optional<std::size_t>> frames;  ///< [cameras] number of its frame; nullopt: none
};

/// Joins the frames of cameras by their times, each used once: `t_ns` [cameras] of rising times. A
/// frame without a partner stays alone. By rising time.
std::vector<JointFrame> JoinFrames(const std::vector<std::vector<std::int64_t>>& t_ns,
                                   const JointFramesTuning& tuning = {});

}  // namespace palpate::experiment
