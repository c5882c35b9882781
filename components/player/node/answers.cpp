// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/answers.hpp"

#include "libs/dds/stamp.hpp"
#include "libs/recording/ros2msg/cdr_reader.hpp"

namespace palpate::player {

std::optional<std::int64_t> StampOfCdr(std::string_view cdr) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  recording::CdrReader reader(cdr);
  const auto seconds = static_cast<std::int32_t>(reader.Bits(4));
  const auto nanoseconds = static_cast<std::int64_t>(reader.Bits(4));
  if (!reader.ok()) return std::nullopt;
  return seconds * kNsPerSecond + nanoseconds;
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
