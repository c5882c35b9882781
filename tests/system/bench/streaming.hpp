// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "tests/system/bench/frame_listener.hpp"
#include "tests/system/virtual_bench.hpp"

namespace palpate::system_test {

/// How long a stream is watched: 6 s, or PALPATE_STREAM_SECONDS.
std::chrono::seconds StreamTime();

/// What was published in a stretch of time, and what of it came.
struct Streamed {
  std::size_t states = 0;      ///< of the virtual robot; 0 where they cannot be heard
  std::size_t sent = 0;        ///< frames that the camera sent, by its own count
  std::size_t frames = 0;      ///< whole frame sets
  std::size_t incomplete = 0;  ///< sets of which a picture or the facts are missing
  double span_s = 0.0;

  double rate_hz() const { return static_cast<double>(frames - 1) / span_s; }
};

/// What of `frames` is whole, but for the first set, which may have begun before anybody listened,
/// and the last two, which may still be on their way. Only sets whose facts came tell the camera's
/// own count.
Streamed CountFrames(const FrameListener::FrameSets& frames, const std::set<std::int64_t>& states);

/// Why a machine cannot show the figures that are asserted; empty: it can. Pictures of 1.2 MB come
/// in bursts, which the receive buffers of a stock kernel (net.core.rmem_max) do not hold.
std::string KernelTrouble();

/// Starts the bench, watches it for StreamTime() once it streams, and prints what came and what
/// each process took under the heading `name`.
Streamed Stream(VirtualBench& bench, FrameListener& listener, const std::string& name);

}  // namespace palpate::system_test
