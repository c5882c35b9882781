// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/node.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"
#include "tests/components/view/client/web_client.hpp"
#include "tests/components/view/node/running_view.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::view {
namespace {

using namespace std::chrono_literals;
using dds::TestDomain;
using dds::TestNode;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;

/// A page that reads what it is sent.
class Page {
 public:
  explicit Page(int port) : client_(port) {
    EXPECT_THAT(client_.Upgrade("/live"), StartsWith("HTTP/1.1 101"));
  }

  /// The next message of this kind; null: none came within 10 s.
  Json Await(const std::string& kind) {
    const auto end = std::chrono::steady_clock::now() + 10s;
    while (std::chrono::steady_clock::now() < end) {
      const auto frame = client_.ReadFrame();
      if (!frame || frame->opcode == 8) break;
      Json message = JsonOf(*frame);
      if (message.value("kind", "") == kind) return message;
    }
    return nullptr;
  }
  WebClient& client() { return client_; }

  static Json JsonOf(const WebClient::Frame& frame) {
    if (frame.opcode == 1) return Json::parse(frame.payload);
    std::uint32_t size = 0;
    std::memcpy(&size, frame.payload.data(), sizeof(size));
    return Json::parse(frame.payload.substr(4, size));
  }

 private:
  WebClient client_;
};

dds::Message<idl::palpate_msgs::ForceArray> Forces(std::uint64_t counter) {
  dds::Message<idl::palpate_msgs::ForceArray> message;
  dds::SetHeader(message->header, 1'700'000'000'123'456'789, geometry::kRobotFrame);
  message->counter = counter;
  dds::SetText(message->status, "ok");
  message->latency_s = 0.031;
  dds::Resize(message->forces, 2);
  auto& known = message->forces._buffer[0];
  dds::SetText(known.name, "leg \"a\"");
  dds::SetVector(known.position_m, Eigen::Vector3d(0.01, -0.02, 0.03));
  dds::SetVector(known.force_n, Eigen::Vector3d(0.3, 0.0, -0.4));
  known.ci95_n = 0.0123456789;
  dds::SetText(known.status, "ok");
  auto& unknown = message->forces._buffer[1];
  dds::SetText(unknown.name, "b");
  dds::SetVector(unknown.force_n, Eigen::Vector3d::Constant(std::nan("")));
  dds::SetText(unknown.status, "unobservable");
  dds::SetText(unknown.reason, "hidden");
  return message;
}

/// A strip of 2 x n nodes.
struct Strip {
  explicit Strip(int n) : nodes_m(3, 2 * n), cells(4, 1), triangles(3, 2 * (n - 1)) {
    for (int i = 0; i < 2 * n; ++i) nodes_m.col(i) << 0.01 * (i / 2), 0.01 * (i % 2), 0.0;
    for (int i = 0; i < 2 * (n - 1); ++i) triangles.col(i) << i, i + 1, i + 2;
    cells << 0, 1, 2, 3;
  }
  Eigen::Matrix3Xd nodes_m;
  Eigen::MatrixXi cells;
  Eigen::Matrix3Xi triangles;
};

TEST(ViewNode, SendsTheForcesOfTheTopic) {
  RunningView view;
  TestNode robot("force_estimation");
  auto writer = robot.participant.CreateWriter(dds::kForcesTopic, robot.Waker());
  ASSERT_TRUE(robot.WaitFor([&] { return writer.matched() > 0; }));
  Page page(view.page_port());
  const Json hello = page.Await("hello");
  EXPECT_EQ(hello.at("source"), "live");
  EXPECT_EQ(hello.at("read_only"), true);
  ASSERT_TRUE(writer.Write(Forces(1)));
  const Json message = page.Await("forces");
  EXPECT_EQ(message.at("stamp_ns"), "1700000000123456789");
  EXPECT_EQ(message.at("latency_s"), 0.031);
  const Json& known = message.at("forces").at(0);
  EXPECT_EQ(known.at("name"), "leg \"a\"");
  EXPECT_EQ(known.at("position_m"), Json({0.01, -0.02, 0.03}));
  EXPECT_EQ(known.at("force_N"), Json({0.3, 0.0, -0.4}));
  EXPECT_DOUBLE_EQ(known.at("magnitude_N").get<double>(), 0.5);
  EXPECT_EQ(known.at("ci95_N"), 0.0123456789);
  const Json& unknown = message.at("forces").at(1);
  EXPECT_TRUE(unknown.at("force_N").is_null());
  EXPECT_EQ(unknown.at("reason"), "hidden");
}

TEST(ViewNode, SendsTheMeshToThoseWhoComeLater) {
  RunningView view;
  TestNode robot("force_estimation");
  auto meshes = robot.participant.CreateWriter(dds::kMeshTopic, robot.Waker());
  auto states = robot.participant.CreateWriter(dds::kMeshStateTopic, robot.Waker());
  ASSERT_TRUE(robot.WaitFor([&] { return meshes.matched() > 0 && states.matched() > 0; }));
  const Strip strip(10);
  ASSERT_TRUE(
      meshes.Write(dds::ToMesh({"strip", "hash", strip.nodes_m, strip.cells, strip.triangles}, 5)));
  Page first(view.page_port());
  const Json mesh = first.Await("mesh");
  EXPECT_EQ(mesh.at("arrays").at("rest_m").at("length"), 60);
  EXPECT_EQ(mesh.at("arrays").at("triangles").at("length"), 54);
  const Eigen::VectorXd x_m = strip.nodes_m.reshaped();
  ASSERT_TRUE(states.Write(dds::ToMeshState(x_m, "hash", 6)));
  EXPECT_EQ(first.Await("mesh_state").at("stamp_ns"), "6");

  Page second(view.page_port());
  EXPECT_EQ(second.Await("mesh").at("hash"), "hash");
  EXPECT_EQ(second.Await("mesh_state").at("arrays").at("positions_m").at("length"), 60);
  second.client().SendText(R"({"kind":"probe","vertex":19})");
  const Json probe = second.Await("probe");
  EXPECT_NEAR(probe.at("position_m").at(0).get<double>(), 0.09, 1e-6);
  EXPECT_EQ(probe.at("displacement_m"), Json({0.0, 0.0, 0.0}));
  second.client().SendText(R"({"kind":"probe","vertex":20})");
  EXPECT_THAT(second.Await("probe").at("reason").get<std::string>(), HasSubstr("no such node"));
}

TEST(ViewNode, TellsTheHealthOfTheProcesses) {
  RunningView view;
  TestNode other("palpate_capture");
  dds::HealthReporter health(other.participant, "capture", dds::WaitSet::Clock::now());
  Page page(view.page_port());
  Json process;
  EXPECT_TRUE(other.WaitFor([&] {
    health.Report({StatusCode::kStale, "no frame"}, {}, {}, dds::WaitSet::Clock::now());
    const Json message = page.Await("health");
    for (const Json& one : message.value("processes", Json::array())) {
      if (one.at("name") == "capture") process = one;
    }
    return !process.is_null();
  }));
  EXPECT_EQ(process.value("reason", ""), "no frame");
  const std::string snapshot = Fetch(view.page_port(), "/snapshot.json");
  EXPECT_THAT(snapshot, HasSubstr("\"other_diagnostics\""));
}

TEST(ViewNode, HasASnapshotFromTheStart) {
  const RunningView view;
  EXPECT_THAT(Fetch(view.page_port(), "/snapshot.json"), HasSubstr("\"processes\":[]"));
}

TEST(ViewNode, RefusesWhatThePageMayNotDo) {
  RunningView view;
  Page page(view.page_port());
  page.client().SendText(R"({"kind":"record","on":true})");
  EXPECT_THAT(page.Await("refused").at("reason").get<std::string>(), HasSubstr("allow_control"));
  page.client().SendText(R"({"kind":"seek","position_s":1})");
  EXPECT_EQ(page.Await("refused").at("request"), "seek");
  page.client().SendText(R"({"kind":"reboot"})");
  EXPECT_EQ(page.Await("refused").at("request"), "reboot");
  const auto close = page.client().ReadFrame();
  EXPECT_TRUE(!close || close->opcode == 8);

  Page eager(view.page_port());
  for (int i = 0; i < 60; ++i) {
    eager.client().SendText(R"({"kind":"subscribe","images":true,"clouds":true})");
  }
  EXPECT_THAT(eager.Await("refused").at("reason").get<std::string>(), HasSubstr("50"));
}

TEST(ViewNode, DoesNotSlowOthersForASlowClient) {
  RunningView view;
  TestNode robot("force_estimation");
  auto meshes = robot.participant.CreateWriter(dds::kMeshTopic, robot.Waker());
  auto states = robot.participant.CreateWriter(dds::kMeshStateTopic, robot.Waker());
  ASSERT_TRUE(robot.WaitFor([&] { return meshes.matched() > 0 && states.matched() > 0; }));
  const Strip strip(10000);  // 240 kB a state
  ASSERT_TRUE(
      meshes.Write(dds::ToMesh({"strip", "hash", strip.nodes_m, strip.cells, strip.triangles}, 5)));
  Page fast(view.page_port());
  ASSERT_FALSE(fast.Await("mesh").is_null());
  Page slow(view.page_port());
  ASSERT_FALSE(slow.Await("mesh").is_null());
  const Eigen::VectorXd x_m = strip.nodes_m.reshaped();
  // Each state is awaited by the fast client before the next one is sent; the slow one reads none.
  constexpr int kStates = 120;
  for (int i = 1; i <= kStates; ++i) {
    ASSERT_TRUE(states.Write(dds::ToMeshState(x_m, "hash", i)));
    ASSERT_EQ(fast.Await("mesh_state").value("stamp_ns", ""), std::to_string(i));
  }
  EXPECT_TRUE(fast.Await("client").at("dropped").empty());
  Json counts;
  do {
    counts = slow.Await("client");
    ASSERT_FALSE(counts.is_null());
  } while (counts.at("dropped").empty());
  EXPECT_GT(counts.at("dropped").at("mesh_state").get<int>(), 10);
}

TEST(ViewNode, IsFoundAgainAfterARestart) {
  auto view = std::make_unique<RunningView>();
  const int port = view->page_port();
  Page page(port);
  EXPECT_FALSE(page.Await("hello").is_null());
  view.reset();
  EXPECT_TRUE(page.client().AwaitEnd());
  NodeConfig config;
  config.http.port = port;
  config.http.further_ports = 0;
  view = std::make_unique<RunningView>(config);
  Page again(port);
  EXPECT_FALSE(again.Await("hello").is_null());
}

TEST(ViewNode, ServesThePage) {
  RunningView view;
  EXPECT_THAT(Fetch(view.page_port(), "/", "Accept-Encoding: gzip\r\n"),
              testing::AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("text/html"),
                             HasSubstr("Content-Encoding: gzip")));
  EXPECT_THAT(Fetch(view.page_port(), "/"), StartsWith("HTTP/1.1 406"));
  EXPECT_THAT(Fetch(view.page_port(), "/../config.hpp"), StartsWith("HTTP/1.1 404"));
}

class Foxglove : public FoxgloveTest {};

TEST_F(Foxglove, GetsTheBytesOfATopicWithItsSchema) {
  RunningView view;
  TestNode robot("force_estimation");
  auto writer = robot.participant.CreateWriter(dds::kForcesTopic, robot.Waker());
  WebClient client(view.foxglove_port());
  EXPECT_THAT(client.Upgrade("/", "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"),
              HasSubstr("Sec-WebSocket-Protocol: foxglove.websocket.v1"));
  EXPECT_EQ(Json::parse(client.ReadFrame().value().payload).at("op"), "serverInfo");
  const Json channel = Channel(&client, "/forces");
  ASSERT_FALSE(channel.is_null());
  EXPECT_EQ(channel.at("encoding"), "cdr");
  EXPECT_EQ(channel.at("schemaEncoding"), "ros2msg");
  EXPECT_EQ(channel.at("schemaName"), "palpate_msgs/msg/ForceArray");
  EXPECT_THAT(channel.at("schema").get<std::string>(), HasSubstr("MSG: palpate_msgs/Force"));

  const auto before = writer.matched();  // the page's own reader
  Subscribe(&client, 7, channel);
  ASSERT_TRUE(robot.WaitFor([&] { return writer.matched() > std::max(before, 1U); }));
  ASSERT_TRUE(writer.Write(Forces(1)));
  const auto data = NextData(&client);
  ASSERT_TRUE(data);
  EXPECT_EQ(data->substr(0, 5), std::string("\x01\x07\x00\x00\x00", 5));
  EXPECT_EQ(data->substr(13, 2), std::string("\x00\x01", 2));  // CDR, little-endian
  EXPECT_NE(data->find("leg \"a\""), data->npos);
  client.SendText(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  EXPECT_TRUE(robot.WaitFor([&] { return writer.matched() <= std::max(before, 1U); }));
}

TEST_F(Foxglove, GetsTheDeformedRobotAsAScene) {
  RunningView view;
  TestNode robot("force_estimation");
  auto meshes = robot.participant.CreateWriter(dds::kMeshTopic, robot.Waker());
  auto states = robot.participant.CreateWriter(dds::kMeshStateTopic, robot.Waker());
  ASSERT_TRUE(robot.WaitFor([&] { return meshes.matched() > 0 && states.matched() > 0; }));
  const Strip strip(3);
  ASSERT_TRUE(
      meshes.Write(dds::ToMesh({"strip", "hash", strip.nodes_m, strip.cells, strip.triangles}, 5)));
  Page page(view.page_port());
  ASSERT_FALSE(page.Await("mesh").is_null());  // the view has it
  WebClient client(view.foxglove_port());
  client.Upgrade("/", "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n");
  const Json channel = Channel(&client, "/view/robot_scene");
  EXPECT_EQ(channel.at("schemaName"), "foxglove.SceneUpdate");
  Subscribe(&client, 1, channel);
  // Its answer says that the subscription before it was taken.
  client.SendText(R"({"op":"unknown"})");
  EXPECT_EQ(Json::parse(client.ReadFrame().value().payload).at("op"), "status");
  const Eigen::VectorXd x_m = strip.nodes_m.reshaped();
  ASSERT_TRUE(states.Write(dds::ToMeshState(x_m, "hash", 6)));
  const auto data = NextData(&client);
  ASSERT_TRUE(data);
  const Json scene = Json::parse(data->substr(13));
  EXPECT_EQ(scene.at("entities").at(0).at("triangles").at(0).at("points").size(), 6U);
}

}  // namespace
}  // namespace palpate::view
