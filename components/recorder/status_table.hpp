// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace palpate::recorder {

/// What is known about one recorded topic.
struct TopicRow {
  std::string topic;
  std::string type;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t lost = 0;    ///< by the counter in the messages, by DDS, or for a slow disk
  double rate_hz = 0.0;      ///< since the last row
  double bytes_per_s = 0.0;  ///< since the last row
  double age_s = 0.0;        ///< of the last message
  bool has_schema = true;
};

struct RecorderStatus {
  double duration_s = 0.0;
  std::vector<TopicRow> topics;
  std::string file;  ///< empty: none is written
  std::uint64_t written_bytes = 0;
  std::uint64_t waiting_bytes = 0;
  bool ended = false;
  double recent_s = 0.0;       ///< in memory, of the topic that reaches back least
  double recent_slot_s = 0.0;  ///< in which one message of the largest topics is kept; 0: all
};

/// Many lines, one for each topic.
std::string StatusTable(const RecorderStatus& status);

/// One line of totals.
std::string StatusLine(const RecorderStatus& status);

/// "12.3 MB", "4.5 kB", "17 B".
std::string SizeText(double bytes);

}  // namespace palpate::recorder
