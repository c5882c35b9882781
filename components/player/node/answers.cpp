// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/answers.hpp"

#include "libs/dds/stamp.hpp"
#include "libs/recording/ros2msg/cdr_reader.hpp"

namespace palpate::player {

std::optional<std::int64_t> StampOfCdr(std::string_view cdr) {
  recording::CdrReader reader(cdr);
  const std::int64_t stamp_ns = reader.Stamp_ns();
  return reader.ok() ? std::optional(stamp_ns) : std::nullopt;
}

Answers::Answers(dds::Participant& participant, dds::WaitSet& loop)
    : forces_(participant.CreateReader(dds::kForcesTopic, [&loop] { loop.Wake(); })) {
  loop.Attach(forces_, [this] {
    for (const auto& forces : forces_.Take()) answered_ns_ = dds::StampNs(forces.header.stamp);
  });
}

void Answers::NoteSent(std::size_t topic, std::string_view cdr, bool is_frame) {
  if (is_frame) {
    sent_.clear();
    awaited_ns_ = StampOfCdr(cdr);
  }
  if (is_waiting()) sent_.emplace_back(topic, cdr);
}

void Answers::Forget() {
  sent_.clear();
  awaited_ns_.reset();
  answered_ns_.reset();
}

}  // namespace palpate::player
