// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/stamp.hpp"

#include <string>

#include "libs/core/utc_text.hpp"
#include "libs/dds/message.hpp"

namespace palpate::dds {

namespace {
constexpr int64_t kNsPerS = 1'000'000'000;
}  // namespace

int64_t StampNs(const idl::builtin_interfaces::Time& time) {
  return int64_t{time.sec} * kNsPerS + int64_t{time.nanosec};
}

idl::builtin_interfaces::Time TimeFromNs(int64_t stamp_ns) {
  // Rounds the seconds down, so that the nanoseconds are positive before the epoch too.
  const int64_t seconds = stamp_ns / kNsPerS - (stamp_ns % kNsPerS < 0 ? 1 : 0);
  PALPATE_CHECK(seconds >= INT32_MIN && seconds <= INT32_MAX, stamp_ns);
  idl::builtin_interfaces::Time time{};
  time.sec = static_cast<int32_t>(seconds);
  time.nanosec = static_cast<uint32_t>(stamp_ns - seconds * kNsPerS);
  return time;
}

int64_t WallClockNs() { return dds_time(); }

std::string StampText(int64_t stamp_ns) { return "stamp " + UtcTextOfNs(stamp_ns); }

Status CheckFrameId(const idl::std_msgs::Header& header, std::string_view expected) {
  const std::string_view frame_id = Text(header.frame_id);
  if (frame_id == expected) return Status::Ok();
  return {StatusCode::kInvalidInput,
          "frame_id is '" + std::string(frame_id) + "', expected '" + std::string(expected) + "'"};
}

void SetHeader(idl::std_msgs::Header& header, int64_t stamp_ns, std::string_view frame_id) {
  header.stamp = TimeFromNs(stamp_ns);
  SetText(header.frame_id, frame_id);
}

}  // namespace palpate::dds
