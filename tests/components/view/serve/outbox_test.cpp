// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/serve/outbox.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "components/view/serve/message_budget.hpp"

namespace palpate::view {
namespace {

using testing::ElementsAre;
using testing::Pair;

std::vector<std::string> Drain(Outbox* outbox) {
  std::vector<std::string> texts;
  while (const auto message = outbox->Pop()) texts.push_back(*message->head);
  return texts;
}

TEST(Outbox, SendsQueuedMessagesFirstAndInOrder) {
  Outbox outbox;
  outbox.Push(BinaryMessage("mesh_state", "m1"));
  outbox.Push(TextMessage("forces", "f1"));
  outbox.Push(BinaryMessage("robot_cloud", "c1"));
  outbox.Push(TextMessage("forces", "f2"));
  EXPECT_EQ(outbox.counts().queue_bytes, 8U);
  EXPECT_THAT(Drain(&outbox), ElementsAre("f1", "f2", "m1", "c1"));
  EXPECT_EQ(outbox.counts().sent, 4U);
  EXPECT_EQ(outbox.counts().queue_bytes, 0U);
  EXPECT_TRUE(outbox.counts().dropped.empty());
}

TEST(Outbox, KeepsTheNewestOfEachLatestKindAndCountsTheOthers) {
  Outbox outbox;
  for (const char* text : {"m1", "m2", "m3"}) outbox.Push(BinaryMessage("mesh_state", text));
  outbox.Push(BinaryMessage("robot_cloud", "c1"));
  EXPECT_THAT(outbox.counts().dropped, ElementsAre(Pair("mesh_state", 2U)));
  EXPECT_THAT(Drain(&outbox), ElementsAre("m3", "c1"));
}

TEST(Outbox, DropsTheOldestQueuedMessageWhereTooManyWait) {
  Outbox outbox({.queued = 2, .queued_bytes = 1000});
  for (const char* text : {"f1", "f2", "f3"}) outbox.Push(TextMessage("forces", text));
  EXPECT_THAT(outbox.counts().dropped, ElementsAre(Pair("forces", 1U)));
  EXPECT_THAT(Drain(&outbox), ElementsAre("f2", "f3"));
}

TEST(Outbox, DropsByBytesButNeverTheNewest) {
  Outbox outbox({.queued = 100, .queued_bytes = 10});
  outbox.Push(TextMessage("a", "12345"));
  outbox.Push(TextMessage("b", std::string(50, 'x')));
  EXPECT_THAT(outbox.counts().dropped, ElementsAre(Pair("a", 1U)));
  EXPECT_EQ(outbox.counts().queue_bytes, 50U);
  EXPECT_THAT(Drain(&outbox), ElementsAre(std::string(50, 'x')));
}

TEST(MessageBudget, RefusesMoreThanItsRate) {
  MessageBudget budget(10.0);
  int taken = 0;
  for (int i = 0; i < 20; ++i) taken += budget.Take(0.0) ? 1 : 0;
  EXPECT_EQ(taken, 10);
  EXPECT_FALSE(budget.Take(0.05));
  EXPECT_TRUE(budget.Take(0.2));
}

}  // namespace
}  // namespace palpate::view
