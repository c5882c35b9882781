// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/status_table.hpp"

#include <gtest/gtest.h>

namespace palpate::recorder {
namespace {

TEST(StatusTable, NamesEachTopicWithItsLosses) {
  RecorderStatus status;
  status.duration_s = 12.0;
  status.topics.push_back({.topic = "/forces",
                           .type = "palpate_msgs/msg/ForceArray",
                           .messages = 360,
                           .bytes = 72'000,
                           .lost = 3,
                           .rate_hz = 30.0,
                           .bytes_per_s = 6000.0});
  status.topics.push_back({.topic = "/tf", .type = "tf2_msgs/msg/TFMessage", .has_schema = false});
  const std::string table = StatusTable(status);
  EXPECT_NE(table.find("/forces      30.0        360    72.0 kB       6.0 kB       3"), table.npos)
      << table;
  EXPECT_NE(table.find("no definition"), table.npos);
  EXPECT_NE(StatusLine(status).find("12.0 s, 2 topics, 360 messages, 3 lost"), std::string::npos);
}

}  // namespace
}  // namespace palpate::recorder
