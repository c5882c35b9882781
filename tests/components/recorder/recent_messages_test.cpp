// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recent_messages.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

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

TEST(RecentMessages, WhereMemoryIsScarceTheLargestTopicsAreThinnedEvenlyAndStayPaired) {
  RecentMessages recent(20.0, 12'000'000);
  const auto depth = SampleTopic("/depth");
  const auto color = SampleTopic("/color");
  const auto small = SampleTopic("/forces");
  for (int i = 0; i < 30 * 60; ++i) {
    recent.Add(SampleMessage(depth, i / 30.0, 80'000));
    recent.Add(SampleMessage(color, i / 30.0 + 0.001, 120'000));
    recent.Add(SampleMessage(small, i / 30.0 + 0.002, 100));
    ASSERT_LE(recent.bytes(), 12'000'000u);
  }
  std::map<std::string, std::vector<std::int64_t>> times_ns;
  for (const RecordedMessage& message : recent.Snapshot()) {
    times_ns[message.topic->topic].push_back(message.received_ns);
  }
  EXPECT_GE(times_ns["/forces"].size(), 600u);
  EXPECT_EQ(recent.shortest_s(), 20.0);
  const auto slot_ns = std::llround(1e9 * recent.slot_s());
  EXPECT_GE(slot_ns, 125'000'000);
  EXPECT_LE(slot_ns, 1'000'000'000);
  for (const char* topic : {"/depth", "/color"}) {
    const std::vector<std::int64_t>& times = times_ns[topic];
    EXPECT_LE(times.front(), times.back() - 20'000'000'000 + 2 * slot_ns) << topic;
    for (std::size_t i = 1; i < times.size(); ++i) {
      EXPECT_LE(times[i] - times[i - 1], 2 * slot_ns) << topic;
    }
    const auto newest = std::count_if(times.begin(), times.end(), [&](std::int64_t time_ns) {
      return time_ns > times.back() - 700'000'000;
    });
    EXPECT_GE(newest, 20) << topic;
  }
  // Each depth image has the colour of its frame.
  std::size_t pairs = 0;
  for (const std::int64_t depth_ns : times_ns["/depth"]) {
    pairs += static_cast<std::size_t>(std::count_if(
        times_ns["/color"].begin(), times_ns["/color"].end(),
        [&](std::int64_t color_ns) { return std::abs(color_ns - depth_ns) < 5'000'000; }));
  }
  EXPECT_GE(pairs + 2, std::min(times_ns["/depth"].size(), times_ns["/color"].size()));
}

TEST(RecentMessages, WhatNeedsLessMemoryAgainIsKeptInFullAgain) {
  RecentMessages recent(2.0, 100'000);
  const auto topic = SampleTopic("/image");
  for (int i = 0; i < 100; ++i) recent.Add(SampleMessage(topic, 0.1 * i, 20'000));
  EXPECT_GT(recent.slot_s(), 0.0);
  for (int i = 100; i < 1000; ++i) recent.Add(SampleMessage(topic, 0.1 * i, 100));
  EXPECT_EQ(recent.slot_s(), 0.0);
  EXPECT_EQ(recent.Snapshot().size(), 21u);
}

TEST(RecentMessages, AMessageLargerThanTheMemoryIsNotKept) {
  RecentMessages recent(2.0, 100'000);
  recent.Add(SampleMessage(SampleTopic("/image"), 0.0, 200'000));
  EXPECT_EQ(recent.bytes(), 0u);
  EXPECT_TRUE(recent.Snapshot().empty());
}

TEST(RecentMessages, WithoutADurationNothingIsKept) {
  RecentMessages recent(0.0, kEnough);
  recent.Add(SampleMessage(SampleTopic("/a"), 0.0));
  EXPECT_TRUE(recent.Snapshot().empty());
}

}  // namespace
}  // namespace palpate::recorder
