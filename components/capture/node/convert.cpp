// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/convert.hpp"

#include "libs/core/check.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::capture {

std::string_view NameOf(ClockSource source) {
  switch (source) {
    case ClockSource::kHostReceive: return "host_receive";
    case ClockSource::kDeviceMapped: return "device_mapped";
    case ClockSource::kPtp: return "ptp";
    case ClockSource::kReplay: return "replay";
  }
  PALPATE_CHECK(false, static_cast<int>(source));
  return "";
}

std::string_view NameOf(SourceState state) {
  switch (state) {
    case SourceState::kDiscover: return "discover";
    case SourceState::kOpen: return "open";
    case SourceState::kConfigure: return "configure";
    case SourceState::kStream: return "stream";
    case SourceState::kStale: return "stale";
    case SourceState::kLost: return "lost";
    case SourceState::kEnded: return "ended";
  }
  PALPATE_CHECK(false, static_cast<int>(state));
  return "";
}

void SetFrameInfo(const SourceFrame& frame, const SourceHealth& health, std::uint64_t counter,
                  std::string_view depth_frame, idl::palpate_msgs::FrameInfo* message) {
  const FrameFacts& facts = frame.facts;
  message->header.stamp = dds::TimeFromNs(facts.stamp_host_ns);
  if (dds::Text(message->header.frame_id) != depth_frame) {
    dds::SetText(message->header.frame_id, depth_frame);
  }
  if (dds::Text(message->device) != health.device) dds::SetText(message->device, health.device);
  if (dds::Text(message->clock_source) != NameOf(facts.clock_source)) {
    dds::SetText(message->clock_source, NameOf(facts.clock_source));
  }
  message->counter = counter;
  message->frame_id = facts.frame_id;
  message->epoch = facts.epoch;
  message->stamp_device_ns = facts.stamp_device_ns;
  message->stamp_host_ns = facts.stamp_host_ns;
  message->stamp_receive_ns = facts.stamp_receive_ns;
  message->pairing_difference_ns = facts.pairing_difference_ns;
  message->exposure_s = facts.exposure_s;
  message->gain_db = facts.gain_dB;
  message->temperature_deg_c = facts.temperature_degC;
  message->depth_unit_m = frame.camera->depth_unit_m;
  message->invalid_value = static_cast<std::uint32_t>(frame.camera->invalid_value);
  message->valid_ratio = facts.valid_ratio;
  message->packets_lost = facts.packets_lost;
  message->packets_resent = facts.packets_resent;
  message->frames_failed = health.frames_failed;
  message->frames_dropped = health.frames_dropped;
  message->socket_drops = health.socket_drops;
}

}  // namespace palpate::capture
