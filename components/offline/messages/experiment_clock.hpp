// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/offline/messages/collected_topics.hpp"

namespace palpate::offline {

/// Sets the time of each item on one clock, and orders each topic by it. Of items of one time the
/// first stays. The clock is that of the stamps; that of the recording where stamps are missing,
/// run backwards or are not those of one clock, which a note says. Stamps since the epoch count
/// from the whole second of the first; returned is that origin, 0 for other stamps.
std::int64_t ChooseClock(CollectedTopics* topics, std::vector<std::string>* notes);

}  // namespace palpate::offline
