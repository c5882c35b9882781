// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/frame_gate.hpp"

#include <gmock/gmock.h>

namespace palpate::force_estimation {
namespace {

using Verdict = FrameGate::Verdict;

FrameHead Head(int64_t stamp_ns, uint64_t counter, const std::string& recording = "a") {
  return {stamp_ns, counter, recording, {}};
}

TEST(FrameGate, ASequenceGoesOnWhileCounterAndStampRise) {
  FrameGate gate;
  EXPECT_EQ(gate.Judge(Head(100, 0)), Verdict::kNewSequence);
  EXPECT_EQ(gate.Judge(Head(200, 1)), Verdict::kNext);
  EXPECT_EQ(gate.Judge(Head(300, 5)), Verdict::kNext);
  EXPECT_EQ(gate.lost(), 3u);
}

TEST(FrameGate, TellsARepeatedFrameFromAStaleOne) {
  FrameGate gate;
  gate.Judge(Head(100, 0));
  gate.Judge(Head(200, 1));
  EXPECT_EQ(gate.Judge(Head(200, 1)), Verdict::kRepeated);
  EXPECT_EQ(gate.Judge(Head(200, 2)), Verdict::kStale);
  EXPECT_EQ(gate.Judge(Head(150, 3)), Verdict::kStale);
  EXPECT_EQ(gate.Judge(Head(201, 4)), Verdict::kNext);
}

TEST(FrameGate, AFallingCounterOrAnotherRecordingBeginsASequence) {
  FrameGate gate;
  gate.Judge(Head(100, 0));
  gate.Judge(Head(200, 1));
  EXPECT_EQ(gate.Judge(Head(100, 0)), Verdict::kTimeWentBack);
  EXPECT_EQ(gate.Judge(Head(200, 1)), Verdict::kNext);
  EXPECT_EQ(gate.Judge(Head(300, 0, "b")), Verdict::kNewSequence);
  EXPECT_EQ(gate.Judge(Head(10, 1, "c")), Verdict::kTimeWentBack);
}

TEST(FrameGate, ComparesWithTheSystemClockOnlyWhereAsked) {
  const FrameHead head = Head(1'000'000'000, 0);
  EXPECT_TRUE(FrameGate::CheckAge(head, 9'000'000'000, 0.0).ok());
  EXPECT_TRUE(FrameGate::CheckAge(head, 1'400'000'000, 0.5).ok());
  const Status old = FrameGate::CheckAge(head, 3'000'000'000, 0.5);
  EXPECT_EQ(old.code(), StatusCode::kStale);
  EXPECT_THAT(old.message(), testing::HasSubstr("2 s old"));
}

}  // namespace
}  // namespace palpate::force_estimation
