// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/clock.hpp"
#include "libs/core/clock_offset.hpp"
#include "libs/dds/entity.hpp"
#include "libs/dds/host.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/participant.hpp"
#include "palpate_msgs/msg/ClockExchange.hpp"

namespace palpate::dds {

/// The clock of another host.
struct HostClock {
  Host host;
  ClockOffset offset;  ///< its clock minus the own one
};

/// The clock that stamps a topic.
struct StampClock {
  Host host;                          ///< of the process that writes it
  std::optional<ClockOffset> offset;  ///< its clock minus the own one; nullopt: not measured yet
};

/// Measures the offsets between the clocks of the hosts of a domain. Each process sends on
/// /clock_exchange, once a second, its time and when it got the last message of each process on
/// another host. Messages are stamped by the thread that receives them. Safe from any thread.
class ClockOffsets {
 public:
  /// `wall`: the own clock. Throws RunError where DDS refuses.
  explicit ClockOffsets(Participant& participant, Host host = ThisHost(), Clock wall = WallNow_ns);
  ClockOffsets(const ClockOffsets&) = delete;
  ClockOffsets& operator=(const ClockOffsets&) = delete;

  /// To be called about once a second. `stamped_topics`: ROS names that this process writes with
  /// stamps of its clock.
  void Send(const std::vector<std::string>& stamped_topics);

  /// Of every other host that was heard in the last 10 s, by its id.
  std::vector<HostClock> All() const;

  /// Of the host whose process stamps a topic; 0 for this host; nullopt: unknown, as of ROS 2's
  /// drivers.
  std::optional<ClockOffset> Of(std::string_view topic) const;
  /// Of a host by its id; 0 for this host; nullopt: not measured yet, or not heard for 10 s.
  std::optional<ClockOffset> OfHost(const std::string& host_id) const;

 private:
  struct Peer {
    Host host;
    std::int64_t sent_ns = 0;      ///< of its last message, by its clock
    std::int64_t received_ns = 0;  ///< by the own clock
    std::vector<std::string> stamped_topics;
    ClockOffsetFilter filter;
  };

  static void OnData(dds_entity_t reader, void* self);
  void Take(const idl::palpate_msgs::ClockExchange& message, std::int64_t received_ns);
  std::optional<ClockOffset> Best(const std::string& host_id, std::int64_t now_ns) const;

  Host host_;
  Clock wall_;
  std::string process_;
  mutable std::mutex mutex_;
  std::map<std::string, Peer> peers_;  ///< by process
  std::vector<std::string> own_topics_;
  Writer<idl::palpate_msgs::ClockExchange> writer_;
  Entity topic_;
  Entity reader_;  ///< goes first: its listener uses the above
};

}  // namespace palpate::dds
