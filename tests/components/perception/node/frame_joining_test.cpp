// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/frame_joining.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "libs/experiment/images/joint_frames.hpp"

/// Frames of several cameras, joined as they come.
namespace palpate::perception {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr auto kWait = milliseconds(100);
const FrameSet::Time kFirstTaken{};

FrameSet SetAt(std::int64_t stamp_ms, FrameSet::Time taken = kFirstTaken) {
  FrameSet set;
  set.stamp_ns = stamp_ms * kMs_ns;
  set.taken = taken;
  return set;
}

/// The stamps of a frame's cameras, ms; -1: none.
std::vector<std::int64_t> StampsOf(const std::optional<JointSet>& joint) {
  std::vector<std::int64_t> stamps_ms;
  if (!joint) return stamps_ms;
  for (const auto& set : joint->sets) stamps_ms.push_back(set ? set->stamp_ns / kMs_ns : -1);
  return stamps_ms;
}

using Stamps = std::vector<std::int64_t>;

TEST(FrameJoining, OfOneCameraPassesEverySetAtOnce) {
  FrameJoining joining(1, kWait);
  for (const std::int64_t stamp_ms : {40, 73, 73, 10}) {  // repeated, then from the beginning
    joining.Add(0, SetAt(stamp_ms));
    const auto joint = joining.Take(kFirstTaken);
    EXPECT_EQ(StampsOf(joint), Stamps{stamp_ms});
    EXPECT_EQ(joint->stamp_ns, stamp_ms * kMs_ns);
  }
  EXPECT_FALSE(joining.Take(kFirstTaken));
  EXPECT_FALSE(joining.NextOverdue());
  EXPECT_EQ(joining.dropped(), 0u);
}

TEST(FrameJoining, WaitsForTheOtherCameraAndHasTheStampOfTheFirst) {
  FrameJoining joining(2, kWait);
  joining.Add(1, SetAt(12));
  EXPECT_FALSE(joining.Take(kFirstTaken));
  EXPECT_EQ(joining.NextOverdue(), kFirstTaken + kWait);
  joining.Add(0, SetAt(20));
  const auto joint = joining.Take(kFirstTaken + milliseconds(5));
  EXPECT_EQ(StampsOf(joint), (Stamps{20, 12}));
  EXPECT_EQ(joint->stamp_ns, 20 * kMs_ns);
  EXPECT_EQ(joint->taken, kFirstTaken + milliseconds(5));
}

/// The same frames as those of a recording with these stamps.
TEST(FrameJoining, JoinsWhatIsJoinedOffline) {
  const std::vector<Stamps> stamps_ms = {{0, 33, 67, 100, 133, 200, 233},
                                         {12, 45, 79, 145, 179, 212, 245}};
  std::vector<std::vector<std::int64_t>> t_ns(2);
  FrameJoining joining(2, kWait);
  std::vector<Stamps> live;
  const auto take = [&](FrameSet::Time now) {
    while (const auto joint = joining.Take(now)) live.push_back(StampsOf(joint));
  };
  for (std::int64_t ms = 0; ms < 300; ++ms) {
    const FrameSet::Time now = kFirstTaken + milliseconds(ms);
    for (std::size_t k = 0; k < 2; ++k) {
      for (const std::int64_t stamp_ms : stamps_ms[k]) {
        if (stamp_ms != ms) continue;
        t_ns[k].push_back(stamp_ms * kMs_ns);
        joining.Add(k, SetAt(stamp_ms, now));
      }
    }
    take(now);
  }
  take(kFirstTaken + milliseconds(1000));
  std::vector<Stamps> offline;
  for (const experiment::JointFrame& frame : experiment::JoinFrames(t_ns)) {
    Stamps& stamps = offline.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      stamps.push_back(frame.frames[k] ? t_ns[k][*frame.frames[k]] / kMs_ns : -1);
    }
  }
  EXPECT_EQ(live, offline);
  EXPECT_EQ(joining.dropped(), 0u);
}

/// Plays frames of both cameras, 33 ms apart, until the second one is gone.
class LostCamera : public testing::Test {
 protected:
  LostCamera() {
    for (int i = 0; i < 4; ++i) {
      Send(0);
      Send(1);
      EXPECT_EQ(StampsOf(joining_.Take(now_)), (Stamps{stamp_ms_, stamp_ms_}));
      Pass();
    }
  }
  void Send(std::size_t camera) { joining_.Add(camera, SetAt(stamp_ms_, now_)); }
  void Pass() {
    stamp_ms_ += 33;
    now_ += milliseconds(33);
  }

  FrameJoining joining_{2, milliseconds(30)};
  std::int64_t stamp_ms_ = 0;
  FrameSet::Time now_ = kFirstTaken;
};

TEST_F(LostCamera, DelaysThreeFramesByTheWaitAndNoneAfterThem) {
  for (int i = 0; i < 3; ++i) {
    Send(0);
    EXPECT_FALSE(joining_.Take(now_ + milliseconds(29)));
    EXPECT_EQ(StampsOf(joining_.Take(now_ + milliseconds(30))), (Stamps{stamp_ms_, -1}));
    Pass();
  }
  Send(0);
  EXPECT_EQ(StampsOf(joining_.Take(now_)), (Stamps{stamp_ms_, -1}));
  Pass();
  // Where it comes again, frames wait for it as before.
  Send(1);
  Send(0);
  EXPECT_EQ(StampsOf(joining_.Take(now_)), (Stamps{stamp_ms_, stamp_ms_}));
  Pass();
  Send(0);
  EXPECT_FALSE(joining_.Take(now_));
}

TEST_F(LostCamera, ASetThatComesAfterItsFrameIsDropped) {
  Send(0);
  EXPECT_TRUE(joining_.Take(now_ + milliseconds(30)));
  Send(1);
  EXPECT_FALSE(joining_.Take(now_ + milliseconds(30)));
  EXPECT_EQ(joining_.dropped(), 1u);
}

TEST_F(LostCamera, TheFirstMayBeTheOneThatIsGone) {
  Send(1);
  const auto joint = joining_.Take(now_ + milliseconds(30));
  EXPECT_EQ(StampsOf(joint), (Stamps{-1, stamp_ms_}));
  EXPECT_EQ(joint->stamp_ns, stamp_ms_ * kMs_ns);
}

TEST(FrameJoining, ACameraOfHalfTheRateIsNotWaitedForInEveryFrame) {
  FrameJoining joining(2, kWait);
  std::vector<Stamps> live;
  for (std::int64_t i = 0; i < 6; ++i) {
    joining.Add(0, SetAt(33 * i));
    if (i % 2 == 0) joining.Add(1, SetAt(33 * i));
    while (const auto joint = joining.Take(kFirstTaken)) live.push_back(StampsOf(joint));
    // Its period is known from its second set on.
    EXPECT_EQ(live.size(), static_cast<std::size_t>(i == 1 ? 1 : i + 1));
  }
  EXPECT_EQ(live,
            (std::vector<Stamps>{{0, 0}, {33, -1}, {66, 66}, {99, -1}, {132, 132}, {165, -1}}));
}

TEST(FrameJoining, BeforeAPeriodIsKnownTheSecondSetIsNoLateOne) {
  FrameJoining joining(2, kWait);
  joining.Add(0, SetAt(33));
  EXPECT_EQ(StampsOf(joining.Take(kFirstTaken + kWait)), (Stamps{33, -1}));
  joining.Add(1, SetAt(66));
  joining.Add(0, SetAt(66));
  EXPECT_EQ(StampsOf(joining.Take(kFirstTaken)), (Stamps{66, 66}));
}

TEST(FrameJoining, ARecordingFromTheBeginningIsJoinedWithNothingOfBefore) {
  FrameJoining joining(2, kWait);
  joining.Add(0, SetAt(1000));
  joining.Add(1, SetAt(1000));
  EXPECT_TRUE(joining.Take(kFirstTaken));
  joining.Add(0, SetAt(1033));
  joining.Add(1, SetAt(5));
  joining.Add(0, SetAt(5));
  EXPECT_EQ(StampsOf(joining.Take(kFirstTaken)), (Stamps{5, 5}));
  EXPECT_EQ(joining.dropped(), 1u);
}

}  // namespace
}  // namespace palpate::perception
