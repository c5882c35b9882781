// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/wrench_slots.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace palpate::force_estimation {
namespace {

constexpr std::int64_t kHold_ns = 1000;

std::string Contact(std::size_t number) { return "contact_" + std::to_string(number); }

TEST(WrenchSlots, AGivenContactHasItsOwnName) {
  WrenchSlots slots({"tip", "left leg"}, kHold_ns);
  EXPECT_EQ(slots.NameOf("tip", 0), "tip");
  EXPECT_EQ(slots.NameOf("left leg", 0), "left_leg");
  EXPECT_EQ(slots.NameOf("contact_7", 0), "slot_1");
}

TEST(WrenchSlots, ContactsOfOneFrameHaveDifferentSlotsAndKeepThem) {
  WrenchSlots slots({}, kHold_ns);
  for (std::int64_t stamp_ns = 0; stamp_ns < 5; ++stamp_ns) {
    EXPECT_EQ(slots.NameOf("contact_3", stamp_ns), "slot_1");
    EXPECT_EQ(slots.NameOf("contact_9", stamp_ns), "slot_2");
  }
}

TEST(WrenchSlots, AContactThatIsMissingForAShortTimeKeepsItsSlot) {
  WrenchSlots slots({}, kHold_ns);
  slots.NameOf("contact_1", 0);
  EXPECT_EQ(slots.NameOf("contact_2", kHold_ns), "slot_2");
  EXPECT_EQ(slots.NameOf("contact_1", kHold_ns), "slot_1");
}

TEST(WrenchSlots, ASlotIsFreeAfterItsContactIsGone) {
  WrenchSlots slots({}, kHold_ns);
  slots.NameOf("contact_1", 0);
  EXPECT_EQ(slots.NameOf("contact_2", kHold_ns + 1), "slot_1");
}

TEST(WrenchSlots, AnyNumberOfContactsOneAfterAnotherHaveASlot) {
  WrenchSlots slots({}, kHold_ns);
  std::set<std::string> names;
  for (std::size_t i = 0; i < 10 * WrenchSlots::kMostSlots; ++i) {
    names.insert(slots.NameOf(Contact(i), static_cast<std::int64_t>(i) * kHold_ns / 2));
  }
  EXPECT_EQ(names, (std::set<std::string>{"slot_1", "slot_2", "slot_3"}));
}

TEST(WrenchSlots, StampsThatFallFreeAllSlots) {
  WrenchSlots slots({}, kHold_ns);
  slots.NameOf("contact_1", 5 * kHold_ns);
  EXPECT_EQ(slots.NameOf("contact_2", 0), "slot_1");
  EXPECT_EQ(slots.NameOf("contact_3", 0), "slot_2");
}

TEST(WrenchSlots, NoMoreThanTheMostAtOnce) {
  WrenchSlots slots({}, kHold_ns);
  for (std::size_t i = 0; i < WrenchSlots::kMostSlots; ++i) {
    EXPECT_FALSE(slots.NameOf(Contact(i), 0).empty());
  }
  EXPECT_EQ(slots.NameOf("one_more", 0), "");
  EXPECT_EQ(slots.NameOf(Contact(0), 0), "slot_1");
}

}  // namespace
}  // namespace palpate::force_estimation
