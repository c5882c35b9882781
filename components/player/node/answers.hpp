// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::player {

/// Waits until /forces has answered a frame: a message with the frame's stamp.
class Answers {
 public:
  /// Throws RunError where DDS refuses.
  Answers(dds::Participant& participant, dds::WaitSet& loop);

  /// A message of the recording was sent. `is_frame`: one that is answered, with a header.
  void NoteSent(std::size_t topic, std::string_view cdr, bool is_frame);
  /// Nothing is waited for any more.
  void Forget();

  bool is_waiting() const { return !!awaited_ns_; }
  std::int64_t awaited_ns() const { return awaited_ns_.value_or(0); }
  bool is_answered() const { return awaited_ns_ == answered_ns_; }

  /// Topics and bytes of what was sent from the last frame on, to send it again.
  const std::vector<std::pair<std::size_t, std::string>>& sent() const { return sent_; }

  bool is_connected() const { return forces_.matched() > 0; }
  std::uint32_t estimators_ever() const { return forces_.counters().matched_ever; }
  const std::string& topic() const { return forces_.ros_name(); }

 private:
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  std::vector<std::pair<std::size_t, std::string>> sent_;
  std::optional<std::int64_t> awaited_ns_;
  std::optional<std::int64_t> answered_ns_;
};

/// Stamp of a message that begins with a std_msgs/Header, ns; nullopt where it is too short.
std::optional<std::int64_t> StampOfCdr(std::string_view cdr);

}  // namespace palpate::player
