// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "builtin_interfaces/msg/Time.hpp"
#include "libs/core/status.hpp"
#include "std_msgs/msg/Header.hpp"

namespace palpate::dds {

/// ns since the epoch of the sender's clock, in [-2^31 s, 2^31 s).
int64_t StampNs(const idl::builtin_interfaces::Time& time);
idl::builtin_interfaces::Time TimeFromNs(int64_t stamp_ns);

/// ns since 1970 by the system clock.
int64_t WallClockNs();

/// "stamp 2026-01-31T12:00:00.250Z", for messages about one frame.
std::string StampText(int64_t stamp_ns);

/// kInvalidInput where a message is of another frame.
Status CheckFrameId(const idl::std_msgs::Header& header, std::string_view expected);

void SetHeader(idl::std_msgs::Header& header, int64_t stamp_ns, std::string_view frame_id);

}  // namespace palpate::dds
