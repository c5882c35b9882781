// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/cable_watch.hpp"

#include <gtest/gtest.h>

namespace palpate::calibration {
namespace {

using State = CableWatch::State;
using Kind = robot::ActuatorCommand::Kind;

constexpr std::int64_t kMs_ns = 1'000'000;

/// One cable, read every 10 ms from `begin_ms` to `end_ms`.
void Read(CableWatch* watch, int begin_ms, int end_ms, double displacement_m) {
  for (int t_ms = begin_ms; t_ms <= end_ms; t_ms += 10) {
    watch->Add({t_ms * kMs_ns, {{displacement_m, std::nullopt}}});
  }
}

CableWatch OneCable() {
  return CableWatch(1, robot::CableInput::kDisplacement, {.still_s = 0.1, .still_m = 1e-4});
}

TEST(CableWatch, RestsOnceTheCablesAreStillForSoLong) {
  CableWatch watch = OneCable();
  EXPECT_EQ(watch.At(0), State::kNotYet);
  Read(&watch, 0, 100, 1e-3);
  Read(&watch, 110, 300, 2e-3);
  EXPECT_EQ(watch.At(100 * kMs_ns), State::kResting);
  EXPECT_EQ(watch.At(150 * kMs_ns), State::kMoving);
  EXPECT_EQ(watch.At(205 * kMs_ns), State::kMoving);  // the reading before it is of the old setting
  EXPECT_EQ(watch.At(210 * kMs_ns), State::kResting);
  EXPECT_EQ(watch.At(301 * kMs_ns), State::kNotYet);
  EXPECT_NEAR(watch.MeanAt(210 * kMs_ns).at(0).value, 2e-3, 1e-15);
}

TEST(CableWatch, DoesNotTrustGapsNorTimesBeforeTheFirstReading) {
  CableWatch watch = OneCable();
  Read(&watch, 0, 100, 1e-3);
  Read(&watch, 160, 300, 1e-3);
  EXPECT_EQ(watch.At(90 * kMs_ns), State::kMoving);   // not known for so long
  EXPECT_EQ(watch.At(200 * kMs_ns), State::kMoving);  // a gap of 60 ms
  EXPECT_EQ(watch.At(270 * kMs_ns), State::kResting);
}

TEST(CableWatch, ForgetsWhenTimeGoesBack) {
  CableWatch watch = OneCable();
  Read(&watch, 1000, 1200, 1e-3);
  watch.Add({0, {{1e-3, std::nullopt}}});
  EXPECT_EQ(watch.At(1200 * kMs_ns), State::kNotYet);
  Read(&watch, 10, 300, 2e-3);
  EXPECT_EQ(watch.At(250 * kMs_ns), State::kResting);
  EXPECT_NEAR(watch.MeanAt(250 * kMs_ns).at(0).value, 2e-3, 1e-15);
}

TEST(CableWatch, JudgesTheInputThatCounts) {
  CableWatch watch(1, robot::CableInput::kTension, {.still_s = 0.1, .still_N = 0.05});
  for (int t_ms = 0; t_ms <= 200; t_ms += 10) {
    watch.Add({t_ms * kMs_ns, {{1e-3 * t_ms, t_ms % 20 == 0 ? 0.41 : 0.39}}});
  }
  EXPECT_EQ(watch.At(150 * kMs_ns), State::kResting);
  EXPECT_EQ(watch.MeanAt(150 * kMs_ns).at(0).kind, Kind::kTension);
  EXPECT_NEAR(watch.MeanAt(150 * kMs_ns).at(0).value, 0.4, 2e-3);
  watch.Add({210 * kMs_ns, {{0.0, 0.45}}});
  EXPECT_EQ(watch.At(210 * kMs_ns), State::kMoving);
}

TEST(CableWatch, AnInputThatBecomesUnknownIsNoRest) {
  CableWatch watch(1, robot::CableInput::kTension, {.still_s = 0.1, .still_N = 0.05});
  for (int t_ms = 0; t_ms <= 200; t_ms += 10) {
    const auto tension_N = t_ms < 150 ? std::optional<double>(0.0) : std::nullopt;
    watch.Add({t_ms * kMs_ns, {{std::nullopt, tension_N}}});
  }
  EXPECT_EQ(watch.At(140 * kMs_ns), State::kResting);
  EXPECT_EQ(watch.At(160 * kMs_ns), State::kMoving);
}

TEST(CableWatch, ARobotWithoutCablesRests) {
  const CableWatch watch(0, robot::CableInput::kDisplacement, {});
  EXPECT_EQ(watch.At(5), State::kResting);
  EXPECT_TRUE(watch.MeanAt(5).empty());
}

}  // namespace
}  // namespace palpate::calibration
