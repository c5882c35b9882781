// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/solve_verb.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/robot/gas_law.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

using experiment::CsvTable;
using test_support::MessageOf;
using testing::AllOf;
using testing::HasSubstr;

/// A finger whose only actuator is the chamber "bend".
class SolveChambers : public testing::Test {
 protected:
  SolveChambers() {
    options_.robot = "pneumatic_finger";
    options_.out = folder_ / "out";
  }

  void Actuate(const std::string& csv) { options_.actuation = folder_.Write("a.csv", csv); }
  std::string Refusal(const std::string& csv) {
    Actuate(csv);
    return MessageOf([&] { Solve(options_); });
  }
  CsvTable Chambers() const { return CsvTable::Read(options_.out / "chambers.csv"); }

  TestFolder folder_;
  SolveOptions options_;
};

TEST_F(SolveChambers, AVolumeLeadsBackToThePressureThatMadeIt) {
  Actuate("t_s,bend.pressure_Pa\n0,0\n1,8e3\n");
  ASSERT_EQ(Solve(options_), 0);
  const CsvTable by_pressure = Chambers();
  EXPECT_EQ(by_pressure.header(),
            (std::vector<std::string>{"row", "chamber", "pressure_Pa", "volume_m3"}));
  ASSERT_EQ(by_pressure.rows(), 2U);
  EXPECT_EQ(by_pressure.Text(1, 1), "bend");
  EXPECT_NEAR(by_pressure.Number(1, 2), 8e3, 1e-6);
  const double volume_m3 = by_pressure.Number(1, 3);
  EXPECT_GT(volume_m3, 1e-7);
  EXPECT_LT(volume_m3, 7e-6);  // that of the chamber
  Actuate("t_s,bend.volume_m3\n0," + FormatNumber(volume_m3) + "\n");
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_NEAR(Chambers().Number(0, 2), 8e3, 0.1);
  EXPECT_NEAR(Chambers().Number(0, 3), volume_m3, 1e-12);
}

TEST_F(SolveChambers, TheInputThatIsWantedIsPrescribedWhereBothAreGiven) {
  Actuate("t_s,bend.pressure_Pa,bend.volume_m3\n0,5e3,0\n");
  options_.cable_input = "tension";
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_NEAR(Chambers().Number(0, 2), 5e3, 1e-6);
  options_.cable_input = "displacement";
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_NEAR(Chambers().Number(0, 3), 0.0, 1e-12);
}

TEST_F(SolveChambers, ColumnsOfCablesOfOtherUnitsAndOfUnknownNamesAreRefused) {
  EXPECT_THAT(
      Refusal("t_s,bend.tension_N\n0,1\n"),
      AllOf(HasSubstr("a.csv:1:5"), HasSubstr("bend.volume_m3"), HasSubstr("bend.pressure_Pa")));
  EXPECT_THAT(Refusal("t_s,bend.pressure_kPa\n0,1\n"), HasSubstr("bend.pressure_Pa"));
  EXPECT_THAT(Refusal("t_s,bent.pressure_Pa\n0,1\n"),
              AllOf(HasSubstr("no chamber 'bent'"), HasSubstr("did you mean 'bend'?")));
}

TEST_F(SolveChambers, WhatNoChamberCanHaveIsRefused) {
  EXPECT_THAT(Refusal("t_s,bend.pressure_Pa\n0,0\n1,-2e5\n"),
              AllOf(HasSubstr("a.csv:3:3"), HasSubstr("below a vacuum")));
  EXPECT_THAT(Refusal("t_s,bend.volume_m3\n0,2\n"), HasSubstr("are these millilitres?"));
  EXPECT_THAT(Refusal("t_s,bend.pressure_Pa\n0,nan\n"), HasSubstr("a.csv:2:3"));
}

TEST_F(SolveChambers, AirThatIsGivenKeepsPressureTimesVolume) {
  Actuate("t_s,bend.air_m3\n0,0\n1,\n2,1e-6\n");
  ASSERT_EQ(Solve(options_), 0);
  const auto model = LoadRobot("pneumatic_finger");
  const robot::BodyChamber& bend = model->body().chambers.front();
  const double rest_m3 = bend.volume_m3 + bend.dead_volume_m3;
  const CsvTable chambers = Chambers();
  ASSERT_EQ(chambers.rows(), 3U);
  for (std::size_t row = 0; row < 3; ++row) {
    const double air_m3 = 0.5e-6 * static_cast<double>(row);
    const double absolute_Pa = robot::kAmbient_Pa + chambers.Number(row, 2);
    EXPECT_NEAR(absolute_Pa * (rest_m3 + chambers.Number(row, 3)) / robot::kAmbient_Pa,
                rest_m3 + air_m3, 1e-12);
  }
  EXPECT_GT(chambers.Number(2, 2), 1e3);
  EXPECT_LT(chambers.Number(2, 3), 1e-6);  // it is compressed
}

TEST_F(SolveChambers, AirIsRefusedWithItsPlaceWhereNoChamberCanHaveIt) {
  EXPECT_THAT(Refusal("t_s,bend.air_m3\n0,0\n1,-1e-3\n"),
              AllOf(HasSubstr("a.csv:3:3"), HasSubstr("with its tube it holds")));
  EXPECT_THAT(Refusal("t_s,bend.pressure_Pa,bend.air_m3\n0,0,0\n"),
              AllOf(HasSubstr("a.csv:1:22"), HasSubstr("'bend.pressure_Pa'")));
  EXPECT_THAT(Refusal("t_s,bent.air_m3\n0,0\n"), HasSubstr("did you mean 'bend'"));
}

TEST_F(SolveChambers, APressureAboveTheSupplysIsNoEquilibriumAndNamesTheChamber) {
  Actuate("t_s,bend.pressure_Pa\n0,0\n1,1e6\n");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(Solve(options_), 1);
  const std::string said =
      testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("bend"));
  const CsvTable chambers = Chambers();
  ASSERT_EQ(chambers.rows(), 2U);
  EXPECT_EQ(chambers.OptionalNumber(1, 2), std::nullopt);
}

}  // namespace
}  // namespace palpate::command
