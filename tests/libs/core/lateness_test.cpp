// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/lateness.hpp"

#include <gmock/gmock.h>

namespace palpate {
namespace {

TEST(Lateness, SaysSoWhileAllMessagesAreLate) {
  Lateness lateness(0.3);
  EXPECT_TRUE(lateness.Judge("frames").ok());
  lateness.Add(0.52);
  lateness.Add(0.61);
  const Status late = lateness.Judge("frames");
  EXPECT_EQ(late.code(), StatusCode::kStale);
  EXPECT_EQ(late.message(), "frames come 0.52 s after they were sent (late_s: 0.3)");
  EXPECT_FALSE(lateness.Judge("frames").ok()) << "nothing has come since";
  lateness.Add(0.02);
  lateness.Add(0.61);
  EXPECT_TRUE(lateness.Judge("frames").ok());
}

TEST(Lateness, JudgesNoRecordingAndNothingWithoutALimit) {
  Lateness lateness(0.3);
  lateness.Add(86400.0);
  EXPECT_TRUE(lateness.Judge("frames").ok());
  Lateness without(0.0);
  without.Add(5.0);
  EXPECT_TRUE(without.Judge("frames").ok());
}

}  // namespace
}  // namespace palpate
