// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/project_files.hpp"

#include <gmock/gmock.h>

#include "libs/core/error.hpp"

namespace palpate::app {
namespace {

using testing::Contains;
using testing::HasSubstr;

const std::filesystem::path kRobots = PALPATE_SOURCE_DIR "/config/robots";

std::string RefusalOf(const std::filesystem::path& robot) {
  try {
    return "found " + RobotFileToRun(robot).string();
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(ProjectFiles, AProcessTakesARobotByNameOrByFile) {
  EXPECT_TRUE(std::filesystem::equivalent(RobotFileToRun("four_leg"), kRobots / "four_leg.yaml"));
  EXPECT_TRUE(std::filesystem::equivalent(RobotFileToRun("rod"), kRobots / "rod.yaml"));
  EXPECT_EQ(RobotFileToRun(kRobots / "beam.yaml"), kRobots / "beam.yaml");
  EXPECT_THAT(KnownRobots(), Contains("rod"));
}

TEST(ProjectFiles, WhatIsNoRobotIsRefusedWithTheRemedy) {
  EXPECT_THAT(RefusalOf("four_lgg"), HasSubstr("no robot file 'four_lgg', nor a robot of that name "
                                               "(did you mean 'four_leg'?)"));
  EXPECT_THAT(RefusalOf("none/robot.yaml"), HasSubstr("no robot file 'none/robot.yaml'"));
  EXPECT_THAT(RefusalOf(""), HasSubstr("ROBOT is required: give a robot file, or the name of a "
                                       "robot (beam, "));
}

TEST(ProjectFiles, AProcessReadsItsRobotWithoutRequiringIt) {
  std::filesystem::path robot;
  Arguments arguments("program", "Do something");
  DeclareRobotToRun(arguments, &robot);
  ASSERT_TRUE(arguments.Parse({}));
  EXPECT_EQ(robot, "");
  ASSERT_TRUE(arguments.Parse({"four_leg"}));
  EXPECT_EQ(robot, "four_leg");
}

}  // namespace
}  // namespace palpate::app
