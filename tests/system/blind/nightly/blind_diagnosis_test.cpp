// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <iostream>

#include "tests/system/blind/acceptance.hpp"
#include "tests/system/blind/blind_set.hpp"

/// Virtual robots with hidden faults, drawn again in each run, and their verdicts by palpate
/// diagnose.
namespace palpate::blind {
namespace {

/// Takes about three minutes of two cores, at most six, simulation included. Samples are half of
/// the command's default. So few cases fail no figure by chance; a fault in all of them does.
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
