// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/answers.hpp"

#include "libs/dds/stamp.hpp"

namespace palpate::virtual_robot {

Answers::Answers(dds::Participant& participant, dds::WaitSet& loop)
    : forces_(participant.CreateReader(dds::kForcesTopic)) {
  loop.Attach(forces_, [this] {
    for (const auto& message : forces_.Take()) {
      const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
      while (!unanswered_ns_.empty() && unanswered_ns_.front() <= stamp_ns) {
        unanswered_ns_.pop_front();
      }
    }
  });
}

}  // namespace palpate::virtual_robot
