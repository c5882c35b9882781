// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/dds/clock_offsets.hpp"

namespace palpate::perception {

struct CameraClocksTuning {
  /// Largest error bound of the offset between the clocks of two cameras. Larger: frames of a
  /// moving robot are joined that show two shapes; smaller: a camera behind a slow link is left
  /// out.
  double largest_bound_s = 0.02;
  /// Longest wait of all frames for a clock that is being measured. Longer: the start takes longer
  /// where a host never answers; shorter: the first frames, which give the depth biases, lack the
  /// camera.
  double longest_wait_s = 5.0;
};

/// The clocks by which several cameras are stamped, and what maps their stamps to the clock of the
/// first. Cameras of one host have one clock. Where a publisher does not tell its host, as a player
/// of recorded messages, its stamps count as of the first camera's clock.
class CameraClocks {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `cameras`: their number, the first one included.
  explicit CameraClocks(std::size_t cameras, const CameraClocksTuning& tuning = {})
      : cameras_(cameras), tuning_(tuning) {}

  /// What is known of a camera's clock now; nullopt: nothing, and what was known before holds.
  void Hear(std::size_t camera, const std::optional<dds::StampClock>& clock, Time now);
  bool IsHeard(std::size_t camera) const { return cameras_[camera].host.has_value(); }

  /// Whether stamps of the camera can be mapped. kStale, with host and reason, where its clock is
  /// not known, or not well enough.
  Status Check(std::size_t camera) const;
  /// To be added to the camera's stamps, ns; 0 where Check() is not ok.
  std::int64_t ToFirst_ns(std::size_t camera) const;
  /// The same difference with its error bound; nullopt: one clock, or not known.
  std::optional<ClockOffset> ToFirst(std::size_t camera) const;

  /// kStale where frames should wait, because a clock is being measured since less than the longest
  /// wait.
  Status CheckWait(Time now) const;

 private:
  struct Camera {
    std::optional<dds::Host> host;
    std::optional<ClockOffset> offset;  ///< its clock minus that of this process
    Time since;                         ///< when this host was heard first
  };

  bool HasFirstsClock(std::size_t camera) const;
  const dds::Host* Unmeasured(std::size_t camera) const;

  std::vector<Camera> cameras_;
  CameraClocksTuning tuning_;
};

}  // namespace palpate::perception
