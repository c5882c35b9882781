// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/robot_source.hpp"

#include <gmock/gmock.h>

#include <utility>

#include "components/view/node/command_line.hpp"
#include "libs/core/error.hpp"
#include "tests/components/view/client/web_client.hpp"
#include "tests/components/view/node/page_messages.hpp"
#include "tests/components/view/node/running_view.hpp"
#include "tests/components/view/robot/cabled_beam.hpp"

namespace palpate::view {
namespace {

using testing::HasSubstr;

TEST(RobotSource, ShowsTheUndeformedBodyWithItsCablesAndStiffness) {
  PageMessages page;
  KnownRobot robot(CabledBeam());
  const Config config;
  PageFeed feed(config, 0, &robot, page.Outputs());
  RobotSource source(robot, &feed);
  source.Show(1'000'000'000);
  source.Show(2'000'000'000);
  EXPECT_TRUE(page.warnings().empty());
  EXPECT_EQ(page.Count("mesh"), 1U) << "a page that has it keeps what is drawn on it";
  EXPECT_EQ(page.Last("mesh").at("robot"), "beam");
  EXPECT_TRUE(page.Last("mesh").at("arrays").contains("stiffness_Pa"));
  EXPECT_EQ(page.Count("mesh_state"), 2U);
  EXPECT_EQ(page.Last("mesh_state").at("status"), "ok");
  EXPECT_EQ(page.Last("mesh_state").at("counter"), 2);
  EXPECT_EQ(page.Last("mesh_state").at("hash"), page.Last("mesh").at("hash"));
  EXPECT_TRUE(page.Last("cable_paths").at("arrays").contains("top"));
  EXPECT_EQ(page.Count("fixed_nodes"), 1U);
  EXPECT_EQ(page.Count("cables"), 0U) << "nobody has measured a tension";
}

TEST(ViewNode, SaysThatARobotFileIsShownAndPlaysNothing) {
  ViewPlan plan;
  plan.source_name = "robot.yaml";
  plan.robot = std::make_unique<KnownRobot>(CabledBeam());
  plan.robot_alone = true;
  const RunningView view({}, std::move(plan));
  WebClient client(view.page_port());
  EXPECT_THAT(client.Upgrade("/live"), testing::StartsWith("HTTP/1.1 101"));
  client.SendText(R"({"kind": "play", "paused": false, "rate": 1})");
  client.SendText(R"({"kind": "record", "on": true})");
  std::vector<std::string> refused;
  Json hello;
  while (refused.size() < 2) {
    const auto frame = client.ReadFrame();
    ASSERT_TRUE(frame) << "the connection has ended";
    if (frame->opcode != 1) continue;
    const Json message = Json::parse(frame->payload);
    if (message.at("kind") == "hello") hello = message;
    if (message.at("kind") == "refused") refused.push_back(message.at("reason"));
  }
  EXPECT_EQ(hello.at("source"), "robot");
  EXPECT_EQ(hello.at("source_name"), "robot.yaml");
  EXPECT_THAT(refused, testing::ElementsAre("nothing is played", "no running system is shown"));
}

TEST(ViewCommand, RefusesASecondRobotBesideARobotFile) {
  Command command;
  command.recording = "finger.yaml";
  command.robot = "four_leg";
  try {
    MakeNode(command);
    FAIL() << "two robots were taken";
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr(
            "--robot: finger.yaml is a robot file, which is shown by itself: leave --robot out"));
  }
}

}  // namespace
}  // namespace palpate::view
