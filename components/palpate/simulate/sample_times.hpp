// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <vector>

#include "libs/scenario/schedule.hpp"

namespace palpate::command {

/// A moment of a recording at which the bench stops.
struct Instant {
  std::int64_t t_ns = 0;  ///< on the bench's clock, which is that of the experiment
  bool markers = false;   ///< the markers are measured
  bool image = false;     ///< the camera takes a frame

  /// What files and bench are told; reads back as the same nanosecond.
  double t_s() const { return static_cast<double>(t_ns) / 1e9; }
};

/// All moments of a recording by rising time, its beginning first, its end not among them: those of
/// markers and camera at their rates, and those at which commands, tools and weights change course.
/// They depend on the scenario alone, never on its effects.
std::vector<Instant> SampleTimes(const scenario::Schedule& schedule, int recording);

/// Where commands change course in the rest before a recording; its end is the first of
/// SampleTimes.
std::vector<Instant> RestTimes(const scenario::Schedule& schedule, int recording);

/// What is done at an instant of the recording. Rounding to whole nanoseconds never leads into the
/// rest before it.
scenario::BenchInputs InputsAt(const scenario::Schedule& schedule, int recording,
                               const Instant& instant);

}  // namespace palpate::command
