// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/cable_history.hpp"

#include <gmock/gmock.h>

namespace palpate::force_estimation {
namespace {

using robot::ActuatorCommand;
using robot::CableInput;

CableReading At(int64_t stamp_ns, double displacement_m) {
  return {stamp_ns, {{displacement_m, std::nullopt}}};
}

TEST(CableHistory, GivesTheInputsOfTheVeryStampElseLinearBetweenTheNeighbours) {
  CableHistory history(1, CableInput::kDisplacement);
  history.Add(At(100, 0.1));
  history.Add(At(200, 0.3));
  EXPECT_EQ(history.At(200)->at(0).value, 0.3);
  EXPECT_EQ(history.At(200)->at(0).kind, ActuatorCommand::Kind::kDisplacement);
  EXPECT_DOUBLE_EQ(history.At(150)->at(0).value, 0.2);
  EXPECT_EQ(history.At(99), std::nullopt);
  EXPECT_EQ(history.At(201), std::nullopt);
}

TEST(CableHistory, ARobotWithoutCablesNeedsNoInputs) {
  EXPECT_TRUE(CableHistory(0, CableInput::kDisplacement).At(5)->empty());
}

TEST(CableHistory, OldInputsServeForALimitedTimeOnly) {
  CableHistory history(1, CableInput::kDisplacement);
  std::vector<ActuatorCommand> commands;
  EXPECT_EQ(history.LastBefore(0, 1.0, &commands).code(), StatusCode::kStale);
  history.Add(At(1'000'000'000, 0.1));
  EXPECT_TRUE(history.LastBefore(1'400'000'000, 0.5, &commands).ok());
  EXPECT_EQ(commands.at(0).value, 0.1);
  const Status old = history.LastBefore(3'000'000'000, 0.5, &commands);
  EXPECT_EQ(old.code(), StatusCode::kStale);
  EXPECT_THAT(old.message(), testing::HasSubstr("2 s older"));
}

TEST(CableHistory, WhereBothInputsAreKnownThePreferredOneIsImposed) {
  CableHistory history(1, CableInput::kTension);
  history.Add({100, {{0.01, 5.0}}});
  EXPECT_EQ(history.At(100)->at(0).kind, ActuatorCommand::Kind::kTension);
  EXPECT_EQ(history.At(100)->at(0).value, 5.0);
  history.Add({200, {{std::nullopt, std::nullopt}}});
  EXPECT_EQ(history.At(200)->at(0).kind, ActuatorCommand::Kind::kNone);
}

TEST(CableHistory, CorrectsForcesByTheSensorThatReadsThem) {
  CableHistory history(2, CableInput::kTension);
  history.Add({100, {{std::nullopt, 4.0}, {0.01, std::nullopt}}});
  history.Add({200, {{std::nullopt, 6.0}, {0.02, std::nullopt}}});
  history.SetForceCorrections({{.gain = 0.5, .offset_N = -1.0}, {.gain = 0.5, .offset_N = -1.0}});
  EXPECT_DOUBLE_EQ(history.At(150)->at(0).value, 6.5);
  EXPECT_DOUBLE_EQ(history.At(150)->at(1).value, 0.015) << "no force";
}

TEST(CableHistory, WhenTimeGoesBackNothingOldIsFound) {
  CableHistory history(1, CableInput::kDisplacement);
  history.Add(At(100, 0.1));
  history.Add(At(200, 0.2));
  history.Add(At(50, 0.5));
  EXPECT_EQ(history.At(100), std::nullopt);
  EXPECT_EQ(history.At(50)->at(0).value, 0.5);
}

TEST(CableHistory, ANewSequenceKeepsItsOwnInputsWhicheverTopicComesFirst) {
  CableHistory cables_first(1, CableInput::kDisplacement);
  cables_first.Add(At(100, 0.1));
  cables_first.BeginSequence(false);
  cables_first.Add(At(50, 0.5));
  cables_first.BeginSequence(true);
  EXPECT_EQ(cables_first.At(50)->at(0).value, 0.5);

  CableHistory markers_first(1, CableInput::kDisplacement);
  markers_first.Add(At(50, 0.1));
  markers_first.Add(At(100, 0.1));
  markers_first.BeginSequence(false);
  markers_first.BeginSequence(true);
  EXPECT_EQ(markers_first.At(50), std::nullopt);
}

}  // namespace
}  // namespace palpate::force_estimation
