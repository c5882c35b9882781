// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/link/connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palpate::capture {
namespace {

using testing::HasSubstr;
using State = SourceState;

/// A connection with a hand-stepped clock.
class Stepped : public testing::Test {
 protected:
  std::int64_t At(double seconds) {
    now_s_ = seconds;
    return static_cast<std::int64_t>(seconds * 1e9);
  }
  std::int64_t After(double seconds) { return At(now_s_ + seconds); }
  Step Next() { return connection_.Next(At(now_s_)); }

  /// Streams from `at_s` on, with one frame.
  void StreamFrom(double at_s) {
    At(at_s);
    ASSERT_EQ(Next(), Step::kOpen);
    connection_.OnOpened(At(at_s));
    ASSERT_EQ(Next(), Step::kConfigure);
    connection_.OnConfigured(At(at_s), 1.0 / 30.0);
    connection_.OnFrame(At(at_s));
    ASSERT_EQ(Next(), Step::kStream);
  }

  Connection connection_{ConnectionTimes()};
  double now_s_ = 0.0;
};

TEST_F(Stepped, OpensConfiguresAndStreams) {
  EXPECT_EQ(connection_.state(), State::kDiscover);
  EXPECT_EQ(Next(), Step::kOpen);
  EXPECT_EQ(connection_.state(), State::kOpen);
  connection_.OnOpened(After(0.1));
  EXPECT_EQ(Next(), Step::kConfigure);
  connection_.OnConfigured(After(0.1), 0.033);
  EXPECT_EQ(Next(), Step::kStream);
  EXPECT_EQ(connection_.state(), State::kStream);
  EXPECT_EQ(connection_.epoch(), 1u);
  EXPECT_TRUE(connection_.reason().empty());
}

TEST_F(Stepped, ALossIsReportedWithinOneAndAHalfSeconds) {
  StreamFrom(0.0);
  At(0.99);
  EXPECT_EQ(Next(), Step::kStream);
  At(1.0);
  EXPECT_EQ(Next(), Step::kProbe);
  EXPECT_EQ(connection_.state(), State::kStale);
  EXPECT_THAT(connection_.reason(), HasSubstr("no frame for 1 s"));
  connection_.OnProbe(At(1.1), Probe::kSilent);
  EXPECT_EQ(connection_.state(), State::kStale);
  connection_.OnProbe(At(1.45), Probe::kSilent);
  EXPECT_EQ(connection_.state(), State::kLost);
  EXPECT_THAT(connection_.reason(), HasSubstr("does not answer"));
  EXPECT_EQ(Next(), Step::kRelease);
  EXPECT_EQ(Next(), Step::kWait);
}

TEST_F(Stepped, ASlowCameraIsStaleAfterFivePeriodsOnly) {
  ASSERT_EQ(Next(), Step::kOpen);
  connection_.OnOpened(At(0.0));
  connection_.OnConfigured(At(0.0), 1.0);
  At(4.9);
  EXPECT_EQ(Next(), Step::kStream);
  At(5.0);
  EXPECT_EQ(Next(), Step::kProbe);
}

TEST_F(Stepped, AFrameEndsStaleness) {
  StreamFrom(0.0);
  At(2.0);
  EXPECT_EQ(Next(), Step::kProbe);
  connection_.OnFrame(At(2.1));
  EXPECT_EQ(Next(), Step::kStream);
  EXPECT_TRUE(connection_.reason().empty());
  EXPECT_EQ(connection_.epoch(), 1u);
}

TEST_F(Stepped, ACameraThatAnswersButSendsNothingIsLostAfterThreeSeconds) {
  StreamFrom(0.0);
  for (double t = 1.0; t < 3.95; t += 0.1) {
    At(t);
    ASSERT_EQ(Next(), Step::kProbe) << t;
    connection_.OnProbe(At(t), Probe::kControlled);
  }
  At(4.0);
  EXPECT_EQ(Next(), Step::kRelease);
  EXPECT_THAT(connection_.reason(), HasSubstr("answers"));
}

TEST_F(Stepped, ACameraThatWasOffForAMomentIsOpenedAnewAtOnce) {
  StreamFrom(0.0);
  At(1.0);
  ASSERT_EQ(Next(), Step::kProbe);
  connection_.OnProbe(At(1.05), Probe::kFree);
  EXPECT_EQ(Next(), Step::kRelease);
  EXPECT_EQ(Next(), Step::kWait);
  At(1.15);
  EXPECT_EQ(Next(), Step::kOpen);
}

TEST_F(Stepped, LostControlCountsWhileStreamingOnly) {
  connection_.OnControlLost(At(0.0));
  EXPECT_EQ(connection_.state(), State::kDiscover);
  StreamFrom(0.0);
  connection_.OnControlLost(At(0.5));
  EXPECT_EQ(connection_.state(), State::kLost);
  EXPECT_EQ(Next(), Step::kRelease);
}

TEST_F(Stepped, AttemptsBackOffFromATenthToTwoSeconds) {
  double at_s = 0.0;
  for (const double wanted_s : {0.1, 0.2, 0.4, 0.8, 1.6, 2.0, 2.0}) {
    At(at_s);
    ASSERT_EQ(Next(), Step::kOpen);
    connection_.OnFailed(At(at_s), "no answer");
    At(at_s + wanted_s - 0.001);
    EXPECT_EQ(Next(), Step::kWait) << wanted_s;
    at_s += wanted_s + 0.001;
  }
}

TEST_F(Stepped, ACameraThatComesBackIsNotKeptWaiting) {
  for (int i = 0; i < 6; ++i) {
    At(10.0 * i);
    ASSERT_EQ(Next(), Step::kOpen);
    connection_.OnFailed(At(10.0 * i), "no answer");
  }
  EXPECT_EQ(Next(), Step::kWait);
  connection_.OnReturn(After(0.1));
  EXPECT_EQ(Next(), Step::kOpen);
}

TEST_F(Stepped, FramesMakeTheBackOffShortAgain) {
  for (int i = 0; i < 6; ++i) {
    At(10.0 * i);
    ASSERT_EQ(Next(), Step::kOpen);
    connection_.OnFailed(At(10.0 * i), "no answer");
  }
  StreamFrom(100.0);
  connection_.OnControlLost(At(101.0));
  EXPECT_EQ(Next(), Step::kRelease);
  At(101.11);
  EXPECT_EQ(Next(), Step::kOpen);
}

TEST_F(Stepped, AnotherProgramsControlIsWaitedOutWithTheDeviceOpen) {
  ASSERT_EQ(Next(), Step::kOpen);
  connection_.OnOpened(At(0.0));
  for (double t = 0.0; t < 3.0; t += 0.25) {
    At(t);
    ASSERT_EQ(Next(), Step::kConfigure) << t;
    connection_.OnAccessDenied(At(t));
    EXPECT_EQ(Next(), Step::kWait);
    EXPECT_THAT(connection_.reason(), HasSubstr("controls"));
  }
  After(0.25);
  EXPECT_EQ(Next(), Step::kConfigure);
  connection_.OnConfigured(After(0.0), 0.0);
  EXPECT_EQ(connection_.state(), State::kStream);
}

TEST_F(Stepped, AProgramThatKeepsTheCameraIsNamedAfterTenSeconds) {
  ASSERT_EQ(Next(), Step::kOpen);
  connection_.OnOpened(At(0.0));
  connection_.OnAccessDenied(At(0.0));
  connection_.OnAccessDenied(At(9.9));
  EXPECT_EQ(connection_.state(), State::kConfigure);
  connection_.OnAccessDenied(At(10.0));
  EXPECT_EQ(connection_.state(), State::kLost);
  EXPECT_EQ(Next(), Step::kRelease);
}

TEST_F(Stepped, EveryOpeningIsAnEpochAndReleasesWhatWasOpen) {
  for (unsigned epoch = 1; epoch <= 50; ++epoch) {
    StreamFrom(100.0 * epoch);
    EXPECT_EQ(connection_.epoch(), epoch);
    connection_.OnControlLost(At(100.0 * epoch + 1.0));
    EXPECT_EQ(Next(), Step::kRelease);
    EXPECT_NE(Next(), Step::kRelease);
  }
}

TEST_F(Stepped, StreamsWithoutOneFrameAreCountedUntilAFrameComes) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(connection_.fruitless_streams(), i);
    At(100.0 * i);
    ASSERT_EQ(Next(), Step::kOpen);
    connection_.OnOpened(At(100.0 * i));
    connection_.OnConfigured(At(100.0 * i), 0.0);
    At(100.0 * i + 1.5);
    ASSERT_EQ(Next(), Step::kProbe);
    At(100.0 * i + 5.0);
    ASSERT_EQ(Next(), Step::kRelease);
    EXPECT_THAT(connection_.reason(), HasSubstr("not one frame"));
  }
  StreamFrom(1000.0);
  EXPECT_EQ(connection_.fruitless_streams(), 0);
}

}  // namespace
}  // namespace palpate::capture
