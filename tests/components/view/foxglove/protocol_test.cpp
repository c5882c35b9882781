// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/foxglove/protocol.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "components/view/foxglove/robot_scene.hpp"

namespace palpate::view::foxglove {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::Pair;

TEST(FoxgloveProtocol, AnswersWithTheFirstOfItsNames) {
  EXPECT_EQ(ChooseSubprotocol({"x", "foxglove.sdk.v1", "foxglove.websocket.v1"}),
            "foxglove.sdk.v1");
  EXPECT_EQ(ChooseSubprotocol({"foxglove.websocket.v1"}), "foxglove.websocket.v1");
  EXPECT_EQ(ChooseSubprotocol({}), std::nullopt);
  EXPECT_EQ(ChooseSubprotocol({"foxglove.websocket.v2"}), std::nullopt);
}

TEST(FoxgloveProtocol, PutsOpcodeSubscriptionAndTimeInFrontOfAMessage) {
  const std::string head = MessageDataHead(0x01020304, 0x1112131415161718);
  EXPECT_EQ(head, std::string("\x01\x04\x03\x02\x01\x18\x17\x16\x15\x14\x13\x12\x11", 13));
}

TEST(FoxgloveProtocol, OffersNoCapability) {
  const Json info = Json::parse(ServerInfoText("palpate", "1", {{"palpate", "0.1"}}));
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_TRUE(info.at("capabilities").empty());
  EXPECT_EQ(info.at("metadata").at("palpate"), "0.1");
}

TEST(FoxgloveProtocol, ReadsSubscriptions) {
  const auto request = ParseRequest(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":2}]})", 9);
  EXPECT_THAT(std::get<Subscribe>(request).subscriptions, ElementsAre(Pair(0U, 3U), Pair(1U, 2U)));
  EXPECT_THAT(
      std::get<Unsubscribe>(ParseRequest(R"({"op":"unsubscribe","subscriptionIds":[1,0]})", 9))
          .subscriptions,
      ElementsAre(1U, 0U));
}

TEST(FoxgloveProtocol, SaysWhyARequestIsNotServed) {
  for (const char* text :
       {"", "[]", "{}", R"({"op":1})", R"({"op":"setParameters"})",
        R"({"op":"subscribe","subscriptions":[{"id":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":["1"]})"}) {
    const auto request = ParseRequest(text, 1);
    ASSERT_TRUE(std::holds_alternative<NotServed>(request)) << text;
    EXPECT_FALSE(std::get<NotServed>(request).reason.empty());
  }
}

PageSurface Triangle() {
  Eigen::Matrix3Xd nodes_m(3, 3);
  nodes_m << 0, 0.1, 0,  //
      0, 0, 0.1,         //
      0, 0, 0;
  return MakePageSurface("hash", nodes_m, Eigen::Vector3i(0, 1, 2));
}

TEST(RobotScene, HasTheDeformedSurfaceAndAnArrowThatEndsAtTheForce) {
  const PageSurface surface = Triangle();
  std::vector<float> positions_m = surface.rest_m;
  positions_m[2] = 0.02F;
  const Json scene = Json::parse(RobotSceneJson(
      surface, positions_m,
      {{"hand", {0.1, 0, 0}, {0, 0, -2}}, {"unknown", {0, 0, 0}, {NAN, 0, 0}}}, 1'500'000'001));
  const Json& robot = scene.at("entities").at(0);
  EXPECT_EQ(robot.at("timestamp"), Json({{"sec", 1}, {"nsec", 500'000'001}}));
  EXPECT_EQ(robot.at("frame_id"), "robot");
  const Json& triangles = robot.at("triangles").at(0);
  EXPECT_NEAR(triangles.at("points").at(0).at("z").get<double>(), 0.02, 1e-5);
  EXPECT_EQ(triangles.at("indices"), Json({0, 1, 2}));
  EXPECT_EQ(triangles.at("colors").size(), 3U);
  EXPECT_NE(triangles.at("colors").at(0), triangles.at("colors").at(1));

  const Json& forces = scene.at("entities").at(1);
  ASSERT_EQ(forces.at("arrows").size(), 1U);
  EXPECT_EQ(forces.at("texts").size(), 2U);
  const Json& arrow = forces.at("arrows").at(0);
  const double length_m =
      arrow.at("shaft_length").get<double>() + arrow.at("head_length").get<double>();
  EXPECT_NEAR(arrow.at("pose").at("position").at("z").get<double>(), length_m, 1e-9);
}

TEST(RobotScene, HasASchemaOfItsEntities) {
  const Json schema = Json::parse(SceneSchema());
  EXPECT_EQ(schema.at("title"), "foxglove.SceneUpdate");
  const Json scene = Json::parse(RobotSceneJson({}, {}, {}, 0));
  const Json& properties = schema.at("properties").at("entities").at("items").at("properties");
  for (const auto& [key, value] : scene.at("entities").at(0).items()) {
    EXPECT_TRUE(properties.contains(key)) << key;
  }
}

}  // namespace
}  // namespace palpate::view::foxglove
