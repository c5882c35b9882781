// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/load_cases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libs/core/error.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

using Kind = robot::ActuatorCommand::Kind;
using robot::CableInput;

LoadCases Read(const std::string& csv, const std::vector<std::string>& cables,
               CableInput preferred = CableInput::kDisplacement) {
  const TestFolder folder;
  std::vector<robot::ActuatorTraits> actuators;
  for (const std::string& cable : cables) actuators.push_back({.name = cable});
  return MakeLoadCases(ReadActuationRows(folder.Write("a.csv", csv)), {}, actuators, preferred);
}

TEST(LoadCases, MakesARowOfEachLineAndInterpolatesEmptyFieldsInTime) {
  const LoadCases cases = Read(
      "t_s,north.displacement_m,south.tension_N\n0,0.001,1\n1,,2\n4,0.005,\n", {"north", "south"});
  ASSERT_EQ(cases.rows.size(), 3U);
  EXPECT_EQ(cases.rows[1].cables[0].kind, Kind::kDisplacement);
  EXPECT_DOUBLE_EQ(cases.rows[1].cables[0].value, 0.002);
  EXPECT_EQ(cases.rows[1].cables[1].kind, Kind::kTension);
  EXPECT_DOUBLE_EQ(cases.rows[2].cables[1].value, 2.0);
  EXPECT_TRUE(cases.notes.empty());
}

TEST(LoadCases, LeavesACableWithoutColumnUndrivenAndSaysSo) {
  const LoadCases cases = Read("t_s,south.tension_N\n0,1\n", {"north", "south"});
  EXPECT_EQ(cases.rows[0].cables[0].kind, Kind::kNone);
  EXPECT_THAT(cases.notes, testing::ElementsAre("cable north is not actuated: its tension is 0"));
}

TEST(LoadCases, ImposesThePreferredOfTwoColumnsAndSaysSo) {
  const std::string csv = "t_s,north.displacement_m,north.tension_N\n0,0.001,3\n";
  EXPECT_EQ(Read(csv, {"north"}).rows[0].cables[0].kind, Kind::kDisplacement);
  const LoadCases by_force = Read(csv, {"north"}, CableInput::kTension);
  EXPECT_EQ(by_force.rows[0].cables[0].kind, Kind::kTension);
  EXPECT_DOUBLE_EQ(by_force.rows[0].cables[0].value, 3.0);
  EXPECT_THAT(by_force.notes,
              testing::ElementsAre(testing::HasSubstr("the tension is prescribed")));
}

TEST(LoadCases, TakesTimesAloneAsRowsUnderWeight) {
  const LoadCases cases = Read("t_s\n0\n0.5\n", {"north"});
  ASSERT_EQ(cases.rows.size(), 2U);
  EXPECT_DOUBLE_EQ(cases.rows[1].t_s, 0.5);
  EXPECT_EQ(cases.rows[1].cables[0].kind, Kind::kNone);
}

TEST(LoadCases, WithoutActuationHasARowForEachTimeOfTheLoads) {
  std::vector<experiment::KnownLoad> loads(3);
  loads[1].t_s = loads[2].t_s = 2.0;
  const LoadCases cases = MakeLoadCases(std::nullopt, loads, {}, CableInput::kDisplacement);
  ASSERT_EQ(cases.rows.size(), 2U);
  EXPECT_EQ(cases.rows[0].loads.size(), 1U);
  EXPECT_EQ(cases.rows[1].loads.size(), 2U);
  EXPECT_EQ(MakeLoadCases(std::nullopt, {}, {}, CableInput::kDisplacement).rows.size(), 1U);
}

TEST(LoadCases, RefusesACableThatTheRobotDoesNotHave) {
  try {
    Read("t_s,nort.displacement_m\n0,1e-3\n", {"north", "south"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a.csv:1:5: the robot has no cable 'nort'"));
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'north'?"));
  }
}

TEST(LoadCases, RefusesTimesThatDoNotRise) {
  EXPECT_THROW(Read("t_s\n1\n1\n", {}), InputError);
  EXPECT_THROW(Read("t_s\n", {}), InputError);
  EXPECT_THROW(Read("t_s\nnan\n", {}), InputError);
}

}  // namespace
}  // namespace palpate::command
