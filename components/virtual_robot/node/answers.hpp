// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::virtual_robot {

/// The states of which no force has come yet. /forces answers each frame with the frame's stamp,
/// which is that of its state; an answer to a later state stands for those before, whose frames
/// were lost.
class Answers {
 public:
  /// Throws RunError where DDS refuses.
  Answers(dds::Participant& participant, dds::WaitSet& loop);

  void NoteSent(std::int64_t stamp_ns) { unanswered_ns_.push_back(stamp_ns); }
  std::size_t Unanswered() const { return unanswered_ns_.size(); }
  /// Nothing is waited for any more.
  void Forget() { unanswered_ns_.clear(); }

 private:
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  std::deque<std::int64_t> unanswered_ns_;  ///< stamps, rising
};

}  // namespace palpate::virtual_robot
