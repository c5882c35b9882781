// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libs/scenario/schedule.hpp"

namespace palpate::command {

/// A sample of a recording: a time at which the simulation stops.
struct Instant {
  std::int64_t t_ns = 0;             ///< on the bench's clock, which is that of the experiment
  bool markers = false;              ///< the markers are measured
  std::vector<std::size_t> cameras;  ///< numbers of those that take a frame; 0: the first

  /// The time in files and for the simulation; reads back as the same nanosecond.
  double t_s() const { return static_cast<double>(t_ns) / 1e9; }
};

/// All samples of a recording in order of time, from its beginning to before its end: those of
/// markers and cameras at their rates, and those at which commands, tools and weights change. They
/// depend on the scenario alone, never on its effects.
std::vector<Instant> SampleTimes(const scenario::Schedule& schedule, int recording);

/// Times at which commands change in the pause before a recording; its end is the first of
/// SampleTimes.
std::vector<Instant> RestTimes(const scenario::Schedule& schedule, int recording);

/// The inputs at a time of the recording. Rounding to whole nanoseconds never leads into the pause
/// before it.
scenario::BenchInputs InputsAt(const scenario::Schedule& schedule, int recording,
                               const Instant& instant);

}  // namespace palpate::command
