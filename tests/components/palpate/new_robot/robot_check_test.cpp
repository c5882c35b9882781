// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/robot_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/palpate/find_robot.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

using testing::HasSubstr;

TEST(RobotCheck, TellsWhatAPullOfACableDoes) {
  const TestFolder folder;
  const auto model = LoadRobot(WriteBarRobot(folder));
  const RobotCheck check = CheckRobot(model.get(), 600.0);
  EXPECT_TRUE(check.ok());
  ASSERT_EQ(check.pulls.size(), 1U);
  EXPECT_GT(check.pulls[0].tension_N, 0.0);
  // The cable runs along the upper edge: the tip rises.
  EXPECT_GT(check.pulls[0].tip_motion_m.z(), check.pulls[0].pull_m);
  EXPECT_GT(check.sag_m, 0.0);
  EXPECT_TRUE(check.warnings.empty());
}

TEST(RobotCheck, EndsInTimeAndSaysWhatWasNotTried) {
  const TestFolder folder;
  const auto model = LoadRobot(WriteBarRobot(folder));
  const RobotCheck check = CheckRobot(model.get(), 0.0);
  EXPECT_TRUE(check.cut_short);
  EXPECT_TRUE(check.ok());
  EXPECT_TRUE(check.pulls.empty());
  ASSERT_EQ(check.warnings.size(), 1U);
  EXPECT_THAT(check.warnings[0], HasSubstr("0 of 1 cables were tried"));
}

}  // namespace
}  // namespace palpate::command
