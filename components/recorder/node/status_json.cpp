// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/status_json.hpp"

#include <nlohmann/json.hpp>

namespace palpate::recorder {

std::string StatusJson(const RecorderStatus& status) {
  nlohmann::ordered_json json = {{"duration_s", status.duration_s},
                                 {"file", status.file},
                                 {"written_bytes", status.written_bytes},
                                 {"waiting_bytes", status.waiting_bytes},
                                 {"recent_s", status.recent_s},
                                 {"recent_slot_s", status.recent_slot_s},
                                 {"ended", status.ended},
                                 {"topics", nlohmann::ordered_json::array()}};
  for (const TopicRow& row : status.topics) {
    json["topics"].push_back({{"topic", row.topic},
                              {"type", row.type},
                              {"messages", row.messages},
                              {"bytes", row.bytes},
                              {"lost", row.lost},
                              {"rate_hz", row.rate_hz},
                              {"bytes_per_s", row.bytes_per_s},
                              {"age_s", row.age_s},
                              {"has_definition", row.has_schema}});
  }
  return json.dump();
}

}  // namespace palpate::recorder
