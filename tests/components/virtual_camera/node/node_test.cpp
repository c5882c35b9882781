// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/node/node.hpp"

#include <gmock/gmock.h>

#include <iostream>
#include <memory>
#include <thread>

#include "libs/core/error.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::virtual_camera {
namespace {

using dds::TestNode;
using ::testing::HasSubstr;

scenario::Scenario SmallScene() {
  scenario::Scenario scenario;
  scenario.name = "test";
  scenario.recordings.resize(1);
  scenario.camera.emplace();
  scenario.camera->camera.depth = {64, 48, 60.0, 60.0, 31.5, 23.5, {}};
  scenario.camera->camera.color = scenario.camera->camera.depth;
  scenario.camera->camera.baseline_m = 0.05;
  scenario.camera->T_robot_camera.translation() = Eigen::Vector3d(0.0, 0.0, -0.4);
  scenario.further_cameras.emplace_back();
  static_cast<scenario::CameraSpec&>(scenario.further_cameras[0]) = *scenario.camera;
  scenario.further_cameras[0].name = "back";
  return scenario;
}

/// A square plate across the line of sight.
dds::Message<idl::palpate_msgs::Mesh> Plate() {
  Eigen::Matrix3Xd nodes_m(3, 4);
  nodes_m << -0.1, 0.1, 0.1, -0.1, -0.1, -0.1, 0.1, 0.1, 0.0, 0.0, 0.0, 0.0;
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 0, 1, 2, 2, 3;
  return dds::ToMesh({"plate", "plate", nodes_m, Eigen::MatrixXi(4, 0), triangles}, 1);
}

class VirtualCameraNodeTest : public ::testing::Test {
 protected:
  VirtualCameraNodeTest()
      : bench_("bench"),
        mesh_(bench_.participant.CreateWriter(dds::kTrueMeshTopic, bench_.Waker())),
        mesh_states_(bench_.participant.CreateWriter(dds::kTrueMeshStateTopic, bench_.Waker())),
        bench_states_(bench_.participant.CreateWriter(dds::kBenchStateTopic, bench_.Waker())),
        status_(bench_.participant.CreateReader(dds::kComponentStatusTopic)) {
    bench_.loop.Attach(status_, [this] {
      for (const auto& message : status_.Take()) {
        component_ = dds::Text(message.component_name);
        published_ = message.published;
        refused_ = message.refused;
        word_ = dds::Text(message.status);
        reason_ = dds::Text(message.reason);
      }
    });
  }
  ~VirtualCameraNodeTest() override {
    if (!node_) return;
    node_->Stop();
    thread_.join();
  }

  /// `camera`: number in the scenario.
  void Start(double silence_s = 30.0, std::size_t camera = 0) {
    NodeConfig config;
    config.interface_address = "127.0.0.51";
    config.silence_s = silence_s;
    node_ = std::make_unique<VirtualCameraNode>(
        config, Scene{{SmallScene(), {}}, "hash", 3, {}, {}, camera},
        static_cast<int>(dds::TestDomain()), dds::BuiltInTable(),
        [](Severity, std::string_view text) { std::cout << text << "\n"; });
    thread_ = std::thread([this] { node_->Run(); });
    ASSERT_TRUE(bench_.WaitFor([this] {
      return mesh_.matched() > 0 && mesh_states_.matched() > 0 && bench_states_.matched() > 0;
    }));
  }

  /// The robot at rest, at that stamp, of a scenario of that hash.
  void Publish(std::int64_t stamp_ns, const std::string& scenario = "hash") {
    dds::Message<idl::palpate_msgs::BenchState> bench;
    dds::SetHeader(bench->header, stamp_ns, "robot");
    dds::SetText(bench->scenario, scenario);
    bench->seed = 3;
    bench->camera_in_robot = dds::ToPose(SmallScene().camera->T_robot_camera);
    EXPECT_TRUE(bench_states_.Write(bench));
    const auto plate = Plate();
    const Eigen::VectorXd x_m = Eigen::Map<const Eigen::VectorXd>(plate->nodes_m._buffer, 12);
    EXPECT_TRUE(mesh_states_.Write(dds::ToMeshState(x_m, "plate", stamp_ns)));
  }

  TestNode bench_;
  dds::Writer<idl::palpate_msgs::Mesh> mesh_;
  dds::Writer<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Writer<idl::palpate_msgs::BenchState> bench_states_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> status_;
  std::unique_ptr<VirtualCameraNode> node_;
  std::thread thread_;
  std::uint64_t published_ = 0;
  std::uint64_t refused_ = 0;
  std::string component_;
  std::string word_;
  std::string reason_;
};

TEST_F(VirtualCameraNodeTest, TakesAPictureOfEachState) {
  ASSERT_TRUE(mesh_.Write(Plate()));
  Start();
  std::int64_t stamp_ns = 0;
  // One state after the other: of those that wait only the newest is drawn.
  EXPECT_TRUE(bench_.WaitFor([&] {
    if (published_ == 0) Publish(++stamp_ns);
    return published_ > 0;
  }));
  EXPECT_EQ(refused_, 0u);
  EXPECT_EQ(word_, "ok");
}

TEST_F(VirtualCameraNodeTest, OfACameraBesideTheFirstIsAComponentOfItsName) {
  ASSERT_TRUE(mesh_.Write(Plate()));
  Start(30.0, 1);
  std::int64_t stamp_ns = 0;
  EXPECT_TRUE(bench_.WaitFor([&] {
    if (published_ == 0) Publish(++stamp_ns);
    return published_ > 0;
  }));
  EXPECT_EQ(component_, "virtual_camera_back");
}

TEST_F(VirtualCameraNodeTest, RefusesTheTruthOfAnotherScenario) {
  ASSERT_TRUE(mesh_.Write(Plate()));
  Start(0.1);
  Publish(1, "another");
  EXPECT_TRUE(bench_.WaitFor([&] { return refused_ > 0 && word_ == "stale"; }));
  EXPECT_THAT(reason_, HasSubstr("another scenario"));
  EXPECT_EQ(published_, 0u);
}

TEST_F(VirtualCameraNodeTest, SaysThatTheRobotIsSilent) {
  Start(0.1);
  EXPECT_TRUE(bench_.WaitFor([&] { return word_ == "stale"; }));
  EXPECT_THAT(reason_, HasSubstr("virtual robot"));
}

TEST_F(VirtualCameraNodeTest, RefusesAScenarioWithoutCameraAtTheStart) {
  scenario::Scenario scenario = SmallScene();
  scenario.camera.reset();
  EXPECT_THROW(VirtualCameraNode({}, Scene{{scenario, {}}, "hash", 3, {}, {}},
                                 static_cast<int>(dds::TestDomain()), dds::BuiltInTable(), {}),
               InputError);
}

}  // namespace
}  // namespace palpate::virtual_camera
