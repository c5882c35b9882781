// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/topic_choice.hpp"

#include <gtest/gtest.h>

#include "components/recorder/status_table.hpp"

namespace palpate::recorder {
namespace {

TEST(TopicChoice, AStarStandsForAnyCharacters) {
  EXPECT_TRUE(Matches("/camera/depth/image_raw", "/camera/*"));
  EXPECT_TRUE(Matches("/camera/depth/image_raw", "*/image_raw"));
  EXPECT_TRUE(Matches("/camera/depth/image_raw", "/camera/*/image_*"));
  EXPECT_TRUE(Matches("/forces", "/forces"));
  EXPECT_TRUE(Matches("/forces", "*"));
  EXPECT_FALSE(Matches("/forces", "/force"));
  EXPECT_FALSE(Matches("/forces", "/forces/*"));
  EXPECT_FALSE(Matches("", "/*"));
}

TEST(TopicChoice, WithoutNamesAllButTheExcludedAreChosen) {
  const TopicChoice all{{}, {"/camera/*"}};
  EXPECT_TRUE(all.Includes("/forces"));
  EXPECT_FALSE(all.Includes("/camera/depth/image_raw"));
  const TopicChoice some{{"/forces*", "/camera/*"}, {"*image_raw"}};
  EXPECT_TRUE(some.Includes("/forces/contact1/wrench"));
  EXPECT_TRUE(some.Includes("/camera/depth/camera_info"));
  EXPECT_FALSE(some.Includes("/camera/depth/image_raw"));
  EXPECT_FALSE(some.Includes("/robot/mesh"));
}

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
