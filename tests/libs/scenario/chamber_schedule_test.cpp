// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "libs/app/yaml.hpp"
#include "libs/scenario/scenario.hpp"
#include "libs/scenario/schedule.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::scenario {
namespace {

Scenario WithPressures(const test_support::TestFolder& folder) {
  return ReadScenario(
      folder.Write("s.yaml",
                   "name: s\nrest_between_s: 0\nrecordings:\n"
                   "  - name: a\n    duration_s: 2\n    commands:\n"
                   "      - {t_s: 0, pull.displacement_m: 0.001, bend.pressure_Pa: 0}\n"
                   "      - {t_s: 2, pull.displacement_m: 0.003, bend.pressure_Pa: 8000}\n"),
      app::LoadYaml);
}

TEST(ChamberSchedule, CommandsComeInTheOrderOfCablesThenChambers) {
  const test_support::TestFolder folder;
  RobotNames robot;
  robot.cables = {"other", "pull"};
  robot.chambers = {"bend"};
  const Schedule schedule(WithPressures(folder), robot.Actuators());
  const Eigen::VectorXd command = schedule.InputsAt(1.0).displacement_m;
  ASSERT_EQ(command.size(), 3);
  EXPECT_TRUE(std::isnan(command[0]));
  EXPECT_DOUBLE_EQ(command[1], 0.002);
  EXPECT_DOUBLE_EQ(command[2], 4000.0);
}

TEST(ChamberSchedule, AChamberThatTheRobotDoesNotHaveIsRefused) {
  const test_support::TestFolder folder;
  EXPECT_THAT(test_support::MessageOf([&] {
                Schedule(WithPressures(folder), {"other", "pull"});
              }),
              testing::HasSubstr("no actuator 'bend'"));
}

}  // namespace
}  // namespace palpate::scenario
