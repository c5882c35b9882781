// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string_view>

namespace palpate::player {

/// What the writers of a topic offered.
struct OfferedQos {
  bool reliable = true;
  bool latched = false;  ///< transient-local: late joiners get the last messages
  int depth = 1;         ///< 0: all are kept

  bool operator==(const OfferedQos&) const = default;
};

/// Reads `offered_qos_profiles` of a channel, the YAML of rosbag2 with numbers (to Humble) or words
/// (from Iron on). Of many writers the one that offers most of each. nullopt: there is no profile.
std::optional<OfferedQos> ParseOfferedQos(std::string_view text);

}  // namespace palpate::player
