// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/frame_pairing.hpp"

#include <gtest/gtest.h>

namespace palpate::perception {
namespace {

using std::chrono::milliseconds;

const FrameSet::Time kStart{};

bool IsWhole(const FrameSet& set) { return set.depth && set.color && set.facts; }

void AddDepth(FramePairing& pairing, std::int64_t stamp_ns, FrameSet::Time now = kStart) {
  pairing.At(stamp_ns, now)->depth.emplace();
}

void AddWhole(FramePairing& pairing, std::int64_t stamp_ns) {
  FrameSet* set = pairing.At(stamp_ns, kStart);
  set->depth.emplace();
  set->color.emplace();
  set->facts = {7, 1};
}

TEST(FramePairing, PartsComeTogetherInAnyOrder) {
  FramePairing pairing(milliseconds(50));
  pairing.At(10, kStart)->facts = {7, 1};
  pairing.At(10, kStart)->color.emplace();
  EXPECT_FALSE(pairing.Take(IsWhole, kStart));
  AddDepth(pairing, 10);
  const auto set = pairing.Take(IsWhole, kStart + milliseconds(1));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->stamp_ns, 10);
  EXPECT_EQ(set->taken - set->since, milliseconds(1));
  EXPECT_FALSE(pairing.Take(IsWhole, kStart));
}

TEST(FramePairing, TheNewestWholeSetWinsAndLatePartsFindNoPlace) {
  FramePairing pairing(milliseconds(50));
  AddDepth(pairing, 10);
  AddWhole(pairing, 20);
  AddWhole(pairing, 30);
  AddDepth(pairing, 40);
  EXPECT_EQ(pairing.Take(IsWhole, kStart)->stamp_ns, 30);
  EXPECT_EQ(pairing.dropped(), 2u);
  EXPECT_EQ(pairing.At(20, kStart), nullptr);
  EXPECT_EQ(pairing.At(30, kStart), nullptr);
  EXPECT_NE(pairing.At(40, kStart), nullptr);
}

TEST(FramePairing, TellsWhenTheNextSetHasWaitedLongEnough) {
  FramePairing pairing(milliseconds(50));
  EXPECT_FALSE(pairing.NextOverdue());
  AddDepth(pairing, 20, kStart);
  AddDepth(pairing, 10, kStart + milliseconds(5));  // the older stamp came later
  ASSERT_TRUE(pairing.NextOverdue());
  EXPECT_EQ(*pairing.NextOverdue(), kStart + milliseconds(50));
  EXPECT_TRUE(pairing.Take(IsWhole, *pairing.NextOverdue()));
  EXPECT_FALSE(pairing.NextOverdue());
}

TEST(FramePairing, ASetThatStaysIncompleteIsGivenUpAfterItsWait) {
  FramePairing pairing(milliseconds(50));
  pairing.At(5, kStart)->color.emplace();
  AddDepth(pairing, 10);
  EXPECT_FALSE(pairing.Take(IsWhole, kStart + milliseconds(49)));
  const auto set = pairing.Take(IsWhole, kStart + milliseconds(50));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->stamp_ns, 10);
  EXPECT_FALSE(set->color);
  EXPECT_EQ(pairing.dropped(), 1u);
}

TEST(FramePairing, ANewCameraMayGoBackInTime) {
  FramePairing pairing(milliseconds(50));
  AddWhole(pairing, 30);
  ASSERT_TRUE(pairing.Take(IsWhole, kStart));
  AddWhole(pairing, 40);
  AddDepth(pairing, 50);
  pairing.Restart(10, 2);
  EXPECT_EQ(pairing.dropped(), 1u);
  EXPECT_NE(pairing.At(10, kStart), nullptr);
}

TEST(FramePairing, WhatPilesUpIsBounded) {
  FramePairing pairing(milliseconds(50));
  for (std::int64_t stamp_ns = 0; stamp_ns < 100; ++stamp_ns) AddDepth(pairing, stamp_ns);
  EXPECT_EQ(pairing.dropped(), 84u);
}

}  // namespace
}  // namespace palpate::perception
