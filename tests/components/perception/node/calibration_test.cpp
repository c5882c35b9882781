// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/perception/node/node_fixture.hpp"

/// The camera's pose that comes on /calibration.
namespace palpate::perception {
namespace {

dds::Message<idl::palpate_msgs::Calibration> Calibration(const std::string& mesh_hash, double z_m,
                                                         const std::string& date_utc) {
  dds::Message<idl::palpate_msgs::Calibration> message;
  dds::SetText(message->mesh_hash, mesh_hash);
  dds::SetText(message->date_utc, date_utc);
  message->has_camera = true;
  message->camera_in_robot = dds::ToPose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, z_m)));
  return message;
}

TEST(CameraPose, HoldsOnceTheMeshSaysThatItIsOfThisRobot) {
  CameraPose pose(std::nullopt);
  ASSERT_TRUE(pose.Take(*Calibration("hash", 0.25, "2026-01-31T12:00:00Z")).ok());
  EXPECT_TRUE(pose.Adopt("").ok());
  EXPECT_FALSE(pose.T_robot_camera());
  EXPECT_TRUE(pose.Adopt("hash").ok());
  ASSERT_TRUE(pose.T_robot_camera());
  EXPECT_EQ(pose.T_robot_camera()->translation().z(), 0.25);
}

TEST(CameraPose, OfAnotherMeshOrOlderOrNoneIsRefusedAndTheOneInUseStays) {
  CameraPose pose(std::nullopt);
  ASSERT_TRUE(pose.Take(*Calibration("hash", 0.25, "2026-01-31T12:00:00Z")).ok());
  ASSERT_TRUE(pose.Adopt("hash").ok());
  ASSERT_TRUE(pose.Take(*Calibration("other", 0.5, "2026-01-31T13:00:00Z")).ok());
  EXPECT_EQ(pose.Adopt("hash").code(), StatusCode::kInvalidInput);
  EXPECT_EQ(pose.Take(*Calibration("hash", 0.5, "2026-01-31T11:59:59Z")).code(),
            StatusCode::kStale);
  auto none = Calibration("hash", 0.5, "2026-01-31T13:00:00Z");
  none->camera_in_robot.orientation.w = 7.0;
  EXPECT_EQ(pose.Take(*none).code(), StatusCode::kInvalidInput);
  EXPECT_TRUE(pose.Adopt("hash").ok());
  EXPECT_EQ(pose.T_robot_camera()->translation().z(), 0.25);
  // What the foreign one said of its date does not keep a newer one out.
  ASSERT_TRUE(pose.Take(*Calibration("hash", 0.75, "2026-01-31T12:30:00Z")).ok());
  EXPECT_TRUE(pose.Adopt("hash").ok());
  EXPECT_EQ(pose.T_robot_camera()->translation().z(), 0.75);
}

void AddCamera(const std::string& name, double z_m, idl::palpate_msgs::Calibration* message) {
  dds::Resize(message->cameras, 1);
  dds::SetText(message->cameras._buffer[0].name, name);
  message->cameras._buffer[0].camera_in_robot =
      dds::ToPose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, z_m)));
}

TEST(CameraPose, OfSeveralCamerasAllMoveOrNone) {
  const Eigen::Isometry3d start(Eigen::Translation3d(0.0, 0.0, 1.0));
  CameraPose pose(start, {{"back", start}});
  const auto alone = Calibration("hash", 0.25, "2026-01-31T12:00:00Z");
  const Status refused = pose.Take(*alone);
  EXPECT_EQ(refused.code(), StatusCode::kNoCalibration);
  EXPECT_THAT(refused.message(), ::testing::HasSubstr("no pose of camera 'back'"));
  EXPECT_TRUE(pose.Adopt("hash").ok());
  EXPECT_EQ(pose.T_robot_camera()->translation().z(), 1.0);
  auto both = Calibration("hash", 0.25, "2026-01-31T12:00:00Z");
  AddCamera("back", 0.5, &*both);
  both->cameras._buffer[0].camera_in_robot.orientation.w = 7.0;
  EXPECT_EQ(pose.Take(*both).code(), StatusCode::kInvalidInput);
  both->cameras._buffer[0].camera_in_robot.orientation.w = 1.0;
  ASSERT_TRUE(pose.Take(*both).ok());
  EXPECT_EQ(pose.further().at(0).T_robot_camera->translation().z(), 1.0) << "not adopted yet";
  ASSERT_TRUE(pose.Adopt("hash").ok());
  EXPECT_EQ(pose.T_robot_camera()->translation().z(), 0.25);
  EXPECT_EQ(pose.further().at(0).T_robot_camera->translation().z(), 0.5);
}

TEST(CameraPose, OfACalibrationFileOfAnotherMeshIsSaidOnceAndOlderOnesAreStale) {
  const Eigen::Isometry3d start(Eigen::Translation3d(0.0, 0.0, 1.0));
  CameraPose pose(start, {}, {"other", "2026-01-31T12:00:00Z"});
  EXPECT_TRUE(pose.Adopt("").ok());
  EXPECT_THAT(pose.Adopt("hash").message(), ::testing::HasSubstr("is for mesh 'other'"));
  EXPECT_TRUE(pose.Adopt("hash").ok());
  EXPECT_EQ(pose.T_robot_camera()->translation().z(), 1.0);
  EXPECT_EQ(pose.Take(*Calibration("hash", 0.5, "2026-01-31T11:59:59Z")).code(),
            StatusCode::kStale);
}

TEST_F(PerceptionNodeTest, PredictsFromThePoseOfANewCalibration) {
  auto calibrations = test_.participant.CreateWriter(dds::kCalibrationTopic);
  StartNode(TestConfig(), false);
  SendMesh();
  SendCamera(SmallCamera(), 1, 1);
  SendMeshState(1 * kSecond_ns, 0.25);
  EXPECT_EQ(Ask(1 * kSecond_ns + 1).prediction_ns, 0);
  ASSERT_TRUE(calibrations.Write(Calibration("hash", 0.125, "2026-01-31T12:00:00Z")));
  ASSERT_TRUE(calibrations.WaitUntilReceived(std::chrono::seconds(5)));
  // Readers do not wait for each other: ask until the node has it.
  for (std::int64_t k = 2; k < 100 && Ask(kSecond_ns + k).prediction_ns == 0;) ++k;
  const auto vertex_m = script_.calls().back().first_vertex_m;
  ASSERT_TRUE(vertex_m);
  EXPECT_EQ(vertex_m->z(), 0.25 - 0.125);
}

TEST_F(PerceptionNodeTest, ThePoseInUseIsOnTfStatic) {
  StartNode(TestConfig(), true);
  dds::TestNode late("late");
  auto transforms = late.participant.CreateReader(dds::kTfStaticTopic);
  dds::TransformTree tree;
  late.loop.Attach(transforms, [&] {
    for (const auto& message : transforms.Take()) EXPECT_TRUE(tree.Add(message).ok());
  });
  const auto z_m = [&] {
    const auto T_robot_camera = tree.Find("robot", "camera_depth_optical_frame");
    return T_robot_camera ? T_robot_camera->translation().z() : 0.0;
  };
  EXPECT_TRUE(late.WaitFor([&] { return z_m() == 0.5; }));
  auto calibrations = test_.participant.CreateWriter(dds::kCalibrationTopic);
  SendMesh();
  ASSERT_TRUE(calibrations.Write(Calibration("hash", 0.125, "2026-01-31T12:00:00Z")));
  EXPECT_TRUE(late.WaitFor([&] { return z_m() == 0.125; }));
}

TEST_F(PerceptionNodeTest, TheAgeOfAFrameIsOfTheClockWithSimTime) {
  NodeConfig config = TestConfig();
  config.dds.use_sim_time = true;
  auto clock = test_.participant.CreateWriter(dds::kClockTopic, test_.Waker());
  StartNode(config);
  ASSERT_TRUE(test_.WaitFor([&] { return clock.matched() == 1; }));
  dds::Message<idl::rosgraph_msgs::Clock> now;
  now->clock = dds::TimeFromNs(7 * kSecond_ns);
  SendCamera(SmallCamera(), 1, 1);
  // The time goes its own way to the node: ask until it is there.
  double age_s = 0.0;
  for (std::int64_t k = 1; k < 100 && age_s <= 0.0; ++k) {
    ASSERT_TRUE(clock.Write(now));
    age_s = Ask(5 * kSecond_ns + k).age_s;
  }
  EXPECT_NEAR(age_s, 2.0, 1e-6);
}

}  // namespace
}  // namespace palpate::perception
