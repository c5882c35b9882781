// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <iostream>

#include "tests/system/blind/acceptance.hpp"
#include "tests/system/blind/blind_set.hpp"

/// Virtual robots with something hidden in them, drawn anew in each run, and what palpate diagnose
/// makes of them.
namespace palpate::blind {
namespace {

/// Some three minutes of two cores, and up to six, with what making them takes: half the moments
/// that a person's diagnosis has. So few condemn nobody by chance; what is found in all of them
/// does.
constexpr int kFewCases = 4;
constexpr int kFewSamples = 60;
constexpr int kFewMinutes = 5;

TEST(BlindDiagnosis, ReachesWhatIsWanted) {
  BlindSet set = BlindSet::FromEnvironment(kFewCases);
  set.samples = kFewSamples;
  set.minutes = kFewMinutes;
  EXPECT_THAT(Missed(Judge(RunBlind(set, std::cout))), testing::IsEmpty());
}

}  // namespace
}  // namespace palpate::blind
