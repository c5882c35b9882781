// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string_view>

#include "components/capture/frame_source.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::capture {

/// "host_receive", "device_mapped", "ptp", "replay".
std::string_view NameOf(ClockSource source);
/// "discover", "open", "configure", "stream", "stale", "lost", "ended".
std::string_view NameOf(SourceState state);

/// Counters since the start are those of `health`. `depth_frame`: of the depth image.
void SetFrameInfo(const SourceFrame& frame, const SourceHealth& health, std::uint64_t counter,
                  std::string_view depth_frame, idl::palpate_msgs::FrameInfo* message);

}  // namespace palpate::capture
