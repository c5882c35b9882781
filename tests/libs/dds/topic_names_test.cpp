// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/topic_names.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/dds/node_settings.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

using testing::HasSubstr;
using Rules = std::vector<std::string>;

TopicNames Names(const Rules& rules, const std::string& node_namespace = "/") {
  return {"my_node", node_namespace, rules, BuiltInTable()};
}

std::string Resolved(const TopicNames& names, const std::string& topic,
                     const std::string& name = {}) {
  return names.Resolve(BuiltInTable().At(topic), name);
}

std::string RefusedRules(const Rules& rules, const std::string& node_namespace = "/") {
  try {
    Names(rules, node_namespace);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TopicNames, WithoutRulesTopicsHaveTheNamesOfTheTable) {
  const TopicNames names = Names({});
  const TopicTable table = BuiltInTable();
  for (const TopicSettings& topic : table.topics()) {
    if (topic.name.find('<') != std::string::npos) continue;
    EXPECT_EQ(names.Resolve(topic), topic.name);
  }
  EXPECT_EQ(Resolved(names, "/forces/<name>/wrench", "tip"), "/forces/tip/wrench");
}

TEST(TopicNames, ANamespaceHoldsForAllButTheGlobalTopics) {
  for (const std::string text : {"/left/robot", "left/robot"}) {
    const TopicNames names = Names({}, text);
    EXPECT_EQ(names.node_namespace(), "/left/robot");
    EXPECT_EQ(Resolved(names, "/forces"), "/left/robot/forces");
    EXPECT_EQ(Resolved(names, "/robot_description"), "/left/robot/robot_description");
    for (const char* global : {"/rosout", "/diagnostics", "/clock", "/tf_static"}) {
      EXPECT_EQ(Resolved(names, global), global);
    }
  }
}

TEST(TopicNames, RulesRenameTopicsWithAndWithoutTheNamespace) {
  const Rules rules{"/camera/depth/image_raw:=/camera/camera/depth/image_rect_raw",
                    "/left/forces:=touch", "/rosout:=/log", "/forces/tip/wrench:=/tip"};
  const TopicNames names = Names(rules, "/left");
  EXPECT_EQ(Resolved(names, "/camera/depth/image_raw"), "/camera/camera/depth/image_rect_raw");
  EXPECT_EQ(Resolved(names, "/forces"), "/left/touch");
  EXPECT_EQ(Resolved(names, "/rosout"), "/log");
  EXPECT_EQ(Resolved(names, "/forces/<name>/wrench", "tip"), "/tip");
  EXPECT_EQ(Resolved(names, "/forces/<name>/wrench", "top"), "/left/forces/top/wrench");
  EXPECT_EQ(Resolved(Names({"forces:=/f"}), "/forces"), "/f");
}

TEST(TopicNames, TheFirstRuleForATopicHolds) {
  EXPECT_EQ(Resolved(Names({"/forces:=/a", "/forces:=/b"}), "/forces"), "/a");
}

TEST(TopicNames, RulesOfNodeAndNamespaceAsRos2HasThem) {
  const TopicNames names = Names({"__node:=left_node", "__ns:=/left"});
  EXPECT_EQ(names.node_name(), "left_node");
  EXPECT_EQ(names.node_namespace(), "/left");
  EXPECT_EQ(Resolved(names, "/forces"), "/left/forces");
}

TEST(TopicNames, ARuleOfAnotherNodeDoesNotHold) {
  const TopicNames names = Names({"other:/forces:=/a", "my_node:/forces:=/b", "other:__ns:=/c"});
  EXPECT_EQ(Resolved(names, "/forces"), "/b");
  EXPECT_EQ(names.node_namespace(), "/");
}

TEST(TopicNames, WhatIsNoRuleOrNameIsRefused) {
  EXPECT_THAT(RefusedRules({"/forces=/a"}), HasSubstr("FROM:=TO"));
  EXPECT_THAT(RefusedRules({"/forces:="}), HasSubstr("FROM:=TO"));
  EXPECT_THAT(RefusedRules({"/force:=/a"}), HasSubstr("did you mean '/forces'"));
  EXPECT_THAT(RefusedRules({"/forces:=/a b"}), HasSubstr("no ROS topic name"));
  EXPECT_THAT(RefusedRules({"__node:=a b"}), HasSubstr("no name of a ROS node"));
  EXPECT_THAT(RefusedRules({"__ns:=/1a"}), HasSubstr("no ROS namespace"));
  EXPECT_THAT(RefusedRules({}, "/a//b"), HasSubstr("no ROS namespace"));
}

TEST(TopicNames, NodesMeetUnderTheNewName) {
  ParticipantSettings settings{.domain_id = TestDomain(), .node_name = "renamed"};
  settings.remap = {"/forces:=/touch"};
  Participant renamed(settings, BuiltInTable());
  auto writer = renamed.CreateWriter(kForcesTopic);
  TopicSettings row;
  row.name = "/touch";
  row.type = "palpate_msgs/msg/ForceArray";
  TestNode other("other", TopicTable(std::vector<TopicSettings>{row}));
  auto reader =
      other.participant.CreateReader(Topic<idl::palpate_msgs::ForceArray>{"/touch"}, other.Waker());
  EXPECT_TRUE(other.WaitFor([&] { return reader.matched() == 1; }));
  EXPECT_EQ(writer.ros_name(), "/touch");
}

TEST(NodeSettings, TheLayoutOfIdentifiersFollowsTheDistribution) {
  for (const char* old : {"", "foxy", "galactic", "humble"}) {
    EXPECT_EQ(GidLayoutOf("auto", old), GidLayout::kHumble) << old;
  }
  for (const char* later : {"iron", "jazzy", "kilted", "rolling"}) {
    EXPECT_EQ(GidLayoutOf("auto", later), GidLayout::kIron) << later;
  }
  EXPECT_EQ(GidLayoutOf("humble", "jazzy"), GidLayout::kHumble);
  EXPECT_EQ(GidLayoutOf("iron", "humble"), GidLayout::kIron);
}

}  // namespace
}  // namespace palpate::dds
