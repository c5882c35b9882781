// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_clocks.hpp"

#include <gmock/gmock.h>

/// The clocks of cameras on several hosts.
namespace palpate::perception {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr CameraClocks::Time kFirstHeard{seconds(100)};

dds::StampClock ClockOf(const std::string& host, std::optional<ClockOffset> offset = {}) {
  return {{host, host}, offset};
}

TEST(CameraClocks, StampsOfPublishersThatTellNoHostStayAsTheyAre) {
  CameraClocks clocks(2);
  EXPECT_TRUE(clocks.Check(1).ok());
  clocks.Hear(0, ClockOf("a", ClockOffset{}), kFirstHeard);
  clocks.Hear(1, std::nullopt, kFirstHeard);
  EXPECT_FALSE(clocks.IsHeard(1));
  EXPECT_TRUE(clocks.Check(1).ok());
  EXPECT_TRUE(clocks.CheckWait(kFirstHeard).ok());
  EXPECT_EQ(clocks.ToFirst_ns(1), 0);
}

TEST(CameraClocks, CamerasOfOneHostHaveOneClockThoughItIsNotMeasured) {
  CameraClocks clocks(2);
  clocks.Hear(0, ClockOf("b"), kFirstHeard);
  clocks.Hear(1, ClockOf("b"), kFirstHeard);
  EXPECT_TRUE(clocks.Check(1).ok());
  EXPECT_TRUE(clocks.CheckWait(kFirstHeard).ok());
  EXPECT_FALSE(clocks.ToFirst(1));
  EXPECT_EQ(clocks.ToFirst_ns(1), 0);
}

/// Clocks minus that of this process: an instant that is 0 here is their offset there.
TEST(CameraClocks, AStampOfOneInstantIsThatOfTheFirstCamera) {
  CameraClocks clocks(3);
  clocks.Hear(0, ClockOf("a", ClockOffset{2.5, 1e-4}), kFirstHeard);
  clocks.Hear(1, ClockOf("b", ClockOffset{-1.25, 2e-4}), kFirstHeard);
  clocks.Hear(2, ClockOf("a", ClockOffset{2.5, 1e-4}), kFirstHeard);
  EXPECT_EQ(-1'250'000'000 + clocks.ToFirst_ns(1), 2'500'000'000);
  EXPECT_NEAR(clocks.ToFirst(1)->bound_s, 3e-4, 1e-15);
  EXPECT_EQ(clocks.ToFirst_ns(2), 0);
  EXPECT_EQ(clocks.ToFirst_ns(0), 0);
}

TEST(CameraClocks, ACameraWhoseClockIsNotKnownIsLeftOutWithItsHostAndAllWaitForIt) {
  CameraClocks clocks(2);
  clocks.Hear(0, ClockOf("a", ClockOffset{}), kFirstHeard);
  clocks.Hear(1, ClockOf("lab2"), kFirstHeard + seconds(1));
  EXPECT_EQ(clocks.Check(1).code(), StatusCode::kStale);
  EXPECT_THAT(clocks.Check(1).message(),
              AllOf(HasSubstr("clock is not known"), HasSubstr("'lab2'"), HasSubstr("doctor")));
  EXPECT_EQ(clocks.ToFirst_ns(1), 0);
  EXPECT_TRUE(clocks.Check(0).ok());
  EXPECT_THAT(clocks.CheckWait(kFirstHeard + seconds(5)).message(), HasSubstr("'lab2'"));
  EXPECT_TRUE(clocks.CheckWait(kFirstHeard + seconds(7)).ok()) << "the others go on";
  clocks.Hear(1, ClockOf("lab2", ClockOffset{0.5, 1e-3}), kFirstHeard + seconds(8));
  EXPECT_TRUE(clocks.Check(1).ok());
  EXPECT_EQ(clocks.ToFirst_ns(1), -500'000'000);
}

TEST(CameraClocks, SoIsOneBesideAFirstCameraOfAnUnknownClock) {
  CameraClocks clocks(2);
  clocks.Hear(0, ClockOf("lab1"), kFirstHeard);
  clocks.Hear(1, ClockOf("here", ClockOffset{}), kFirstHeard);
  EXPECT_THAT(clocks.Check(1).message(), HasSubstr("'lab1'"));
}

TEST(CameraClocks, OneThatIsKnownTooCoarselyIsLeftOutWithItsBound) {
  CameraClocks clocks(2, {.largest_bound_s = 0.02});
  clocks.Hear(0, ClockOf("a", ClockOffset{0.0, 0.005}), kFirstHeard);
  clocks.Hear(1, ClockOf("lab2", ClockOffset{0.5, 0.0199}), kFirstHeard);
  EXPECT_THAT(clocks.Check(1).message(),
              AllOf(HasSubstr("'lab2'"), HasSubstr("+- 24.9 ms"), HasSubstr("+- 20 ms")));
  EXPECT_EQ(clocks.ToFirst_ns(1), 0);
  EXPECT_TRUE(clocks.CheckWait(kFirstHeard).ok()) << "it is measured";
  clocks.Hear(1, ClockOf("lab2", ClockOffset{0.5, 0.0149}), kFirstHeard);
  EXPECT_TRUE(clocks.Check(1).ok());
}

TEST(CameraClocks, WhatWasKnownHoldsWhereAHostIsGoneAndNotForAnotherOne) {
  CameraClocks clocks(2);
  clocks.Hear(0, ClockOf("a", ClockOffset{}), kFirstHeard);
  clocks.Hear(1, ClockOf("b", ClockOffset{0.5, 1e-3}), kFirstHeard);
  clocks.Hear(0, std::nullopt, kFirstHeard);
  clocks.Hear(1, ClockOf("b"), kFirstHeard);
  EXPECT_EQ(clocks.ToFirst_ns(1), -500'000'000);
  clocks.Hear(1, ClockOf("c"), kFirstHeard);
  EXPECT_FALSE(clocks.Check(1).ok());
}

}  // namespace
}  // namespace palpate::perception
