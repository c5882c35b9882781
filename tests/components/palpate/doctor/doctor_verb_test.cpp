// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/doctor/doctor_verb.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/palpate/node/verbs.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {
namespace {

using testing::HasSubstr;

/// What the verb prints, and its exit code, whatever this machine is like.
struct Output {
  int exit_code = -1;
  std::string text;
};

Output RunDoctor(std::vector<std::string> words) {
  words.insert(words.begin(), "doctor");
  testing::internal::CaptureStdout();
  Output output;
  output.exit_code = RunCommand(words);
  output.text = testing::internal::GetCapturedStdout();
  return output;
}

TEST(Doctor, NamesEveryCheckOnce) {
  const Output output = RunDoctor({"--json", "--robot", "rod"});
  const auto json = nlohmann::json::parse(output.text);
  std::vector<std::string> names;
  for (const auto& check : json["checks"]) names.push_back(check["name"]);
  EXPECT_THAT(names,
              testing::ElementsAre("domain", "receive buffers", "DDS settings", "interface",
                                   "discovery", "participants", "versions", "clocks", "camera",
                                   "processor", "disk", "security", "robot files"));
  EXPECT_EQ(output.exit_code, json["grade"] == "fail" ? 1 : 0);
}

TEST(Doctor, AFileThatDoesNotFitFailsWithItsReason) {
  const Output output = RunDoctor({"--robot", "rod", "--calibration", "no_such.yaml"});
  EXPECT_EQ(output.exit_code, 1);
  EXPECT_THAT(output.text, HasSubstr("fail  robot files      no_such.yaml"));
  EXPECT_THAT(output.text, HasSubstr("failed\n"));
}

TEST(Doctor, ADomainThatIsNoneIsACheckThatFails) {
  const char* variable = std::getenv("ROS_DOMAIN_ID");
  const std::string before = variable == nullptr ? "0" : variable;
  setenv("ROS_DOMAIN_ID", "abc", 1);
  const Output output = RunDoctor({});
  setenv("ROS_DOMAIN_ID", before.c_str(), 1);
  EXPECT_EQ(output.exit_code, 1);
  EXPECT_THAT(output.text, HasSubstr("fail  domain           environment variable ROS_DOMAIN_ID"));
}

TEST(Doctor, RefusesACalibrationWithoutItsRobot) {
  EXPECT_THROW(RunCommand({"doctor", "--calibration", "c.yaml"}), InputError);
}

}  // namespace
}  // namespace palpate::command
