// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recent_messages.hpp"

#include <gmock/gmock.h>

#include "tests/components/recorder/sample_messages.hpp"

namespace palpate::recorder {
namespace {

constexpr std::uint64_t kEnough = 1'000'000;

TEST(RecentMessages, KeepsTheLastSecondsAndNoMore) {
  RecentMessages recent(2.0, kEnough);
  const auto topic = SampleTopic("/a");
  for (int i = 0; i < 100; ++i) recent.Add(SampleMessage(topic, 0.1 * i));
  const auto kept = recent.Snapshot();
  ASSERT_EQ(kept.size(), 21u);
  EXPECT_EQ(kept.front().received_ns, 7'900'000'000);
  EXPECT_EQ(kept.back().received_ns, 9'900'000'000);
  EXPECT_EQ(recent.bytes(), 2100u);
  EXPECT_EQ(recent.shortest_s(), 2.0);
}

TEST(RecentMessages, ATopicThatFellSilentIsNotOlderThanTheOthers) {
  RecentMessages recent(2.0, kEnough);
  const auto silent = SampleTopic("/silent");
  const auto topic = SampleTopic("/a");
  recent.Add(SampleMessage(silent, 0.0));
  for (int i = 0; i < 100; ++i) recent.Add(SampleMessage(topic, 0.1 * i));
  for (const RecordedMessage& message : recent.Snapshot()) {
    EXPECT_EQ(message.topic->topic, "/a");
  }
}

TEST(RecentMessages, ALatchedMessageIsKeptHoweverOld) {
  RecentMessages recent(1.0, kEnough);
  const auto latched = SampleTopic("/mesh", true);
  const auto topic = SampleTopic("/a");
  recent.Add(SampleMessage(latched, 0.0, 1));
  recent.Add(SampleMessage(latched, 1.0, 2));
  for (int i = 20; i < 100; ++i) recent.Add(SampleMessage(topic, 0.1 * i));
  recent.Add(SampleMessage(latched, 10.0, 3));
  recent.Add(SampleMessage(topic, 30.0));
  const auto kept = recent.Snapshot();
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].topic->topic, "/mesh");
  EXPECT_EQ(kept[0].data.size(), 3u);
}

TEST(RecentMessages, WhereMemoryIsScarceTheLargestTopicReachesBackLeast) {
  RecentMessages recent(10.0, 100'000);
  const auto images = SampleTopic("/image");
  const auto small = SampleTopic("/forces");
  for (int i = 0; i < 100; ++i) {
    recent.Add(SampleMessage(images, 0.1 * i, 20'000));
    recent.Add(SampleMessage(small, 0.1 * i, 100));
  }
  EXPECT_LE(recent.bytes(), 100'000u);
  std::size_t forces = 0;
  std::size_t pictures = 0;
  for (const RecordedMessage& message : recent.Snapshot()) {
    ++(message.topic == small ? forces : pictures);
  }
  EXPECT_EQ(forces, 100u);
  EXPECT_EQ(pictures, 4u);
  EXPECT_NEAR(recent.shortest_s(), 0.3, 1e-9);
}

TEST(RecentMessages, WithoutADurationNothingIsKept) {
  RecentMessages recent(0.0, kEnough);
  recent.Add(SampleMessage(SampleTopic("/a"), 0.0));
  EXPECT_TRUE(recent.Snapshot().empty());
}

}  // namespace
}  // namespace palpate::recorder
