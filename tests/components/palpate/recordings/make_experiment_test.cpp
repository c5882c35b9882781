// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/make_experiment.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "components/palpate/reference_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/components/palpate/recordings/topic_recording.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kImage[] = "sensor_msgs/msg/Image";
constexpr char kInfo[] = "sensor_msgs/msg/CameraInfo";
const std::filesystem::path kFinger = PALPATE_SOURCE_DIR "/config/robots/pneumatic_finger.yaml";

/// A recording and the experiment that it becomes.
class MakeExperimentTest : public testing::Test {
 protected:
  /// Depth 2 x 2 of realsense-ros' names, with padded rows.
  void AddDepth(int index, const std::string& camera = "/camera/camera/depth") {
    const std::int64_t t_ns = kStart_ns + index * kStep_ns;
    const auto low = static_cast<std::uint8_t>(index + 1);
    messages_.Add(camera + "/image_rect_raw", kImage, t_ns + 5'000'000,
                  ImageMessage(t_ns, "camera_depth_optical", 2, 2, "16UC1", 6,
                               {low, 1, 2, 0, 9, 9, 3, 0, 255, 255, 9, 9}));
  }
  void AddDepthInfo(const std::string& camera = "/camera/camera/depth") {
    messages_.Add(camera + "/camera_info", kInfo, kStart_ns,
                  CameraInfoMessage("camera_depth_optical", 2, 2));
  }
  void AddJoints(int index, const std::string& cable, double position_m,
                 const std::vector<double>& effort = {}) {
    const std::int64_t t_ns = kStart_ns + index * kStep_ns;
    Cdr cdr;
    cdr.Stamp(t_ns, "").Put(std::uint32_t{1}).Text(cable);
    cdr.List<double>({position_m}).List<double>({}).List<double>(effort);
    messages_.Add("/robot/joint_states", "sensor_msgs/msg/JointState", t_ns, cdr);
  }
  void AddPhase(std::int64_t t_ns, const std::string& text) {
    messages_.Add("/experiment/phase", "std_msgs/msg/String", t_ns, Cdr().Text(text));
  }

  experiment::Experiment Make(const std::vector<std::string>& remap = {},
                              const std::filesystem::path& robot = {}) {
    messages_.WriteMcap(folder_ / "run.mcap");
    notes_ = offline::MakeExperiment(folder_ / "run.mcap", remap, robot, out_, app::LoadYaml);
    return experiment::ReadExperiment(out_, app::LoadYaml);
  }
  std::string Refusal(const std::vector<std::string>& remap = {}) {
    return MessageOf([&] { Make(remap); });
  }
  std::string Notes() const {
    std::string all;
    for (const std::string& note : notes_) all += note + "\n";
    return all;
  }

  const TestFolder folder_;
  const std::filesystem::path out_ = folder_ / "experiment";
  TopicRecording messages_;
  std::vector<std::string> notes_;
};

TEST_F(MakeExperimentTest, DepthOfARealsenseBecomesImagesBitForBit) {
  AddDepthInfo();
  for (int i = 0; i < 3; ++i) AddDepth(i);
  const auto experiment = Make();
  ASSERT_EQ(experiment.recordings.size(), 1u);
  const auto& recording = experiment.recordings.front();
  EXPECT_EQ(recording.name, "run");
  EXPECT_EQ(recording.kind, experiment::RecordingKind::kFree);
  EXPECT_THAT(Notes(), HasSubstr("1 recording(s) of kind free: neither /experiment/phase nor "));
  EXPECT_THAT(Notes(), HasSubstr("run.phases.yaml names another"));
  EXPECT_THAT(Notes(), HasSubstr("no camera pose"));
  const auto sequence = experiment::OpenRecordingImages(recording, app::LoadYaml);
  EXPECT_EQ(sequence.camera.depth.fx_px, 10.0);
  EXPECT_EQ(sequence.camera.depth_unit_m, 0.001);
  rgbd::RgbdFrame frame;
  sequence.Read(1, &frame);
  EXPECT_EQ(frame.stamp_ns, kStep_ns);
  EXPECT_THAT(frame.depth.values, ElementsAre(258, 2, 3, 65535));
}

TEST_F(MakeExperimentTest, ASqliteRecordingGivesTheSameAsAnMcapFile) {
  AddDepthInfo();
  AddDepth(0);
  AddDepth(1);
  AddJoints(0, "north", 0.01);
  messages_.WriteSqlite(folder_ / "run.db3");
  offline::MakeExperiment(folder_ / "run.db3", {}, {}, folder_ / "of_db3", app::LoadYaml);
  Make();
  for (const char* name : {"actuation.csv", "camera.yaml", "depth/0.png", "depth/100000000.png"}) {
    EXPECT_EQ(ReadFile(out_ / "recordings/run" / name),
              ReadFile(folder_ / "of_db3/recordings/run" / name))
        << name;
  }
}

TEST_F(MakeExperimentTest, FilesOfOneFolderAreOneRecording) {
  AddDepthInfo();
  AddDepth(0);
  std::filesystem::create_directories(folder_ / "bag");
  folder_.Write("bag/metadata.yaml", "rosbag2_bagfile_information:\n");
  messages_.WriteMcap(folder_ / "bag/bag_0.mcap");
  messages_.entries.clear();
  AddDepth(1);
  messages_.WriteMcap(folder_ / "bag/bag_1.mcap");
  offline::MakeExperiment(folder_ / "bag", {}, {}, out_, app::LoadYaml);
  const auto experiment = experiment::ReadExperiment(out_, app::LoadYaml);
  EXPECT_EQ(experiment.recordings.front().depth_images.size(), 2u);
}

TEST_F(MakeExperimentTest, DepthInMetresKeepsWholeMillimetres) {
  messages_.Add("/depth/camera_info", kInfo, kStart_ns, CameraInfoMessage("optical", 3, 1));
  const float values[] = {1.234f, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()};
  std::vector<std::uint8_t> data(sizeof(values));
  std::memcpy(data.data(), values, sizeof(values));
  messages_.Add("/depth/image_raw", kImage, kStart_ns,
                ImageMessage(kStart_ns, "optical", 3, 1, "32FC1", 12, data));
  const auto experiment = Make();
  EXPECT_THAT(rgbd::ReadDepthPng(out_ / "recordings/run/depth/0.png").values,
              ElementsAre(1234, 0, 0));
}

TEST_F(MakeExperimentTest, BigEndianImagesAndMessagesAreRead) {
  messages_.Add("/d/camera_info", kInfo, kStart_ns, CameraInfoMessage("optical", 2, 1));
  Cdr cdr(Cdr::Order::kBig);
  cdr.Stamp(kStart_ns, "optical").Put(std::uint32_t{1}).Put(std::uint32_t{2}).Text("16UC1");
  cdr.Put(std::uint8_t{1}).Put(std::uint32_t{4}).List<std::uint8_t>({1, 2, 3, 4});
  messages_.Add("/d/image", kImage, kStart_ns, cdr);
  Make();
  EXPECT_THAT(rgbd::ReadDepthPng(out_ / "recordings/run/depth/0.png").values,
              ElementsAre(0x0102, 0x0304));
}

TEST_F(MakeExperimentTest, ColourGoesWithTheDepthImageNearInTime) {
  AddDepthInfo();
  for (int i = 0; i < 3; ++i) AddDepth(i);
  const std::int64_t t_ns = kStart_ns + kStep_ns + 20'000'000;
  messages_.Add("/camera/camera/color/camera_info", kInfo, kStart_ns,
                CameraInfoMessage("camera_color_optical", 1, 1));
  messages_.Add("/camera/camera/color/image_raw", kImage, t_ns,
                ImageMessage(t_ns, "camera_color_optical", 1, 1, "bgr8", 3, {1, 2, 3}));
  messages_.Add("/tf_static", "tf2_msgs/msg/TFMessage", kStart_ns,
                TransformMessage("camera_depth_optical", "camera_color_optical", 0.015));
  messages_.Add("/tf_static", "tf2_msgs/msg/TFMessage", kStart_ns,
                TransformMessage("robot", "camera_depth_optical", 0.5));
  const auto experiment = Make();
  EXPECT_THAT(rgbd::ReadColorPng(out_ / "recordings/run/color/100000000.png").values,
              ElementsAre(3, 2, 1));
  const auto camera = rgbd::ReadCameraFile(out_ / "recordings/run/camera.yaml", app::LoadYaml);
  EXPECT_EQ(camera.T_depth_color.translation().x(), 0.015);
  ASSERT_TRUE(experiment.T_robot_camera);
  EXPECT_EQ(experiment.T_robot_camera->translation().x(), 0.5);
}

TEST_F(MakeExperimentTest, WordsOfTheTopicMakePhases) {
  AddDepthInfo();
  for (int i = 0; i < 6; ++i) AddDepth(i);
  for (int i = 0; i < 6; ++i) AddJoints(i, "north", 0.001 * i);
  AddPhase(kStart_ns, "rest");
  AddPhase(kStart_ns + 2 * kStep_ns, "hold pulled");
  AddPhase(kStart_ns + 4 * kStep_ns, "end");
  const auto experiment = Make();
  ASSERT_EQ(experiment.recordings.size(), 2u);
  EXPECT_EQ(experiment.recordings[0].name, "r01_rest");
  EXPECT_EQ(experiment.recordings[1].name, "r02_pulled");
  EXPECT_EQ(experiment.recordings[1].kind, experiment::RecordingKind::kHold);
  EXPECT_EQ(experiment.recordings[0].depth_images.size(), 2u);
  EXPECT_EQ(experiment.recordings[1].depth_images.size(), 2u);
  EXPECT_THAT(experiment.recordings[1].actuation->t_s, ElementsAre(0.2, 0.3));
}

TEST_F(MakeExperimentTest, AFileBesideNamesPhasesCablesAndFrames) {
  AddDepthInfo();
  for (int i = 0; i < 4; ++i) AddDepth(i);
  AddJoints(0, "motor_1", 0.25);
  messages_.Add("/tf_static", "tf2_msgs/msg/TFMessage", kStart_ns,
                TransformMessage("base_link", "camera_depth_optical", 0.5));
  folder_.Write("run.phases.yaml",
                "robot_frame: base_link\ncables: {motor_1: north}\n"
                "experiment: {rest_between_s: 2}\n"
                "phases:\n  - {name: a, kind: rest, window_s: [0, 0.1]}\n"
                "  - {name: b, kind: hold, window_s: [0.15, 0.4], steady_window_s: [0.2, 0.3]}\n");
  const auto experiment = Make();
  ASSERT_EQ(experiment.recordings.size(), 2u);
  EXPECT_EQ(experiment.recordings[0].depth_images.size(), 2u);
  EXPECT_EQ(experiment.recordings[1].steady_window_s->begin_s, 0.2);
  EXPECT_EQ(experiment.recordings[1].actuation->columns.front().cable, "north");
  EXPECT_EQ(experiment.recordings[1].actuation->columns.front().samples.front(), 0.25);
  EXPECT_EQ(experiment.rest_between_s, 2.0);
  EXPECT_EQ(experiment.T_robot_camera->translation().x(), 0.5);
}

TEST(PhaseFile, HasItsKeysInTheReference) {
  const std::string text = Reference({"phases"}, false);
  for (const char* key : {"`load_point_m`", "`robot_frame`", "`window_s`", "`cables`"}) {
    EXPECT_THAT(text, HasSubstr(key));
  }
}

TEST_F(MakeExperimentTest, PhasesThatOverlapOrAreNotInOrderAreRefused) {
  AddDepthInfo();
  AddDepth(0);
  folder_.Write("run.phases.yaml",
                "phases:\n  - {name: a, kind: rest, window_s: [0, 1]}\n"
                "  - {name: b, kind: hold, window_s: [0.5, 2]}\n");
  EXPECT_THAT(Refusal(), HasSubstr("run.phases.yaml:3:5: key 'phases[1]': begins before"));
}

TEST_F(MakeExperimentTest, AWrenchIsALoadWhereItsFrameIs) {
  AddDepthInfo();
  AddDepth(0);
  AddDepth(1);
  messages_.Add("/tf_static", "tf2_msgs/msg/TFMessage", kStart_ns,
                TransformMessage("robot", "hook", 0.3));
  Cdr wrench;
  wrench.Stamp(kStart_ns, "hook").Array<double>({0, 0, -0.5, 0, 0, 0});
  messages_.Add("/ft", "geometry_msgs/msg/WrenchStamped", kStart_ns, wrench);
  const auto experiment = Make();
  ASSERT_EQ(experiment.recordings.front().loads.size(), 1u);
  EXPECT_EQ(experiment.recordings.front().loads.front().position_m, Eigen::Vector3d(0.3, 0, 0));
  EXPECT_EQ(experiment.recordings.front().loads.front().force_N, Eigen::Vector3d(0, 0, -0.5));
}

TEST_F(MakeExperimentTest, AWrenchWithoutAPlaceIsTold) {
  AddDepthInfo();
  AddDepth(0);
  Cdr wrench;
  wrench.Stamp(kStart_ns, "sensor").Array<double>({0, 0, -0.5, 0, 0, 0});
  messages_.Add("/ft", "geometry_msgs/msg/WrenchStamped", kStart_ns, wrench);
  EXPECT_TRUE(Make().recordings.front().loads.empty());
  EXPECT_THAT(Notes(), HasSubstr("/ft is not used as loads: where frame 'sensor' acts"));
}

TEST_F(MakeExperimentTest, TwoDepthCamerasAreAskedFor) {
  for (const char* camera : {"/left/depth", "/right/depth"}) {
    AddDepthInfo(camera);
    AddDepth(0, camera);
  }
  EXPECT_THAT(Refusal(), HasSubstr("more than one topic could be /camera/depth/image_raw: "
                                   "/left/depth/image_rect_raw (16UC1, 2 x 2), "
                                   "/right/depth/image_rect_raw (16UC1, 2 x 2); name one with "
                                   "--remap /left/depth/image_rect_raw:=/camera/depth/image_raw"));
  std::filesystem::remove(folder_ / "run.mcap");
  EXPECT_EQ(Make({"/left/depth/image_rect_raw:=/camera/depth/image_raw"}).recordings.size(), 1u);
}

TEST_F(MakeExperimentTest, MissingIntrinsicsAreNamed) {
  AddDepth(0);
  EXPECT_THAT(Refusal(), HasSubstr("/camera/camera/depth/image_rect_raw: no intrinsics: the "
                                   "recording has no sensor_msgs/CameraInfo beside it"));
}

TEST_F(MakeExperimentTest, AnUnknownLensIsRefusedWithTheRemedy) {
  messages_.Add("/d/camera_info", kInfo, kStart_ns,
                CameraInfoMessage("optical", 2, 1, "equidistant", {0.1, 0.2, 0.3, 0.4}));
  messages_.Add("/d/image", kImage, kStart_ns,
                ImageMessage(kStart_ns, "optical", 2, 1, "16UC1", 4, {1, 2, 3, 4}));
  EXPECT_THAT(
      Refusal(),
      HasSubstr("/d/camera_info: distortion model 'equidistant' with 4 numbers "
                "instead of plumb_bob with 5 finite ones or rational_polynomial with 8: record "
                "the rectified image"));
}

TEST_F(MakeExperimentTest, ARecordingWithoutMeasurementsIsRefusedWithItsTopics) {
  AddJoints(0, "north", 0.0);
  EXPECT_THAT(Refusal(), HasSubstr("holds no depth images"));
  std::filesystem::remove(folder_ / "run.mcap");
  EXPECT_THAT(Refusal(), HasSubstr("/robot/joint_states (sensor_msgs/msg/JointState)"));
}

TEST_F(MakeExperimentTest, JointsOfAnArmAreRefusedWithTheRemedy) {
  AddDepthInfo();
  AddDepth(0);
  AddJoints(0, "shoulder", 2.5);
  EXPECT_THAT(Refusal(),
              HasSubstr("leave the topic out with --remap /robot/joint_states:=/unused"));
  std::filesystem::remove(folder_ / "run.mcap");
  EXPECT_FALSE(Make({"/robot/joint_states:=/unused"}).recordings.front().actuation);
}

TEST_F(MakeExperimentTest, JointsAreChambersWhereTheRobotFileSaysSo) {
  AddDepthInfo();
  AddDepth(0);
  AddJoints(0, "bend", 2e-6, {12e3});
  const auto experiment = Make({}, kFinger);
  const auto& columns = experiment.recordings.front().actuation->columns;
  ASSERT_EQ(columns.size(), 2U);
  EXPECT_TRUE(columns[0].of_chamber);
  EXPECT_EQ(columns[0].samples, (std::vector<std::optional<double>>{2e-6}));
  EXPECT_EQ(columns[1].samples, (std::vector<std::optional<double>>{12e3}));
  EXPECT_THAT(ReadFile(experiment.recordings.front().folder / "actuation.csv"),
              HasSubstr("bend.volume_m3,bend.pressure_Pa"));
  EXPECT_THAT(Notes(), testing::Not(HasSubstr("taken for cables")));
}

TEST_F(MakeExperimentTest, TheAttachedRobotSaysWhichJointsAreChambers) {
  AddDepthInfo();
  AddDepth(0);
  AddJoints(0, "bend", 2e-6, {12e3});
  recording::Attachment robot;
  robot.name = "finger.yaml";
  robot.data = ReadFile(kFinger);
  messages_.attachments = {robot};
  EXPECT_TRUE(Make().recordings.front().actuation->columns.front().of_chamber);
}

TEST_F(MakeExperimentTest, WithoutARobotJointsAreCablesAndTheNotesSaySo) {
  AddDepthInfo();
  AddDepth(0);
  AddJoints(0, "bend", 2e-6);
  EXPECT_FALSE(Make().recordings.front().actuation->columns.front().of_chamber);
  EXPECT_THAT(Notes(), HasSubstr("joint states are taken for cables: no robot file is known"));
}

TEST_F(MakeExperimentTest, WhatNoChamberCanHaveIsRefusedAndACableThatPushesNamesTheRemedy) {
  AddDepthInfo();
  AddDepth(0);
  AddJoints(0, "bend", 0.0, {-2e4});
  EXPECT_THAT(Refusal(), testing::AllOf(HasSubstr("a cable cannot push"), HasSubstr("--robot")));
  std::filesystem::remove(folder_ / "run.mcap");
  EXPECT_THAT(MessageOf([&] { Make({}, "no_such_robot.yaml"); }), HasSubstr("no_such_robot"));
  std::filesystem::remove(folder_ / "run.mcap");
  AddJoints(1, "bend", 0.0, {-2e5});
  EXPECT_THAT(MessageOf([&] { Make({}, kFinger); }), HasSubstr("below a vacuum"));
}

TEST_F(MakeExperimentTest, RulesThatFitNothingAreRefused) {
  AddDepth(0);
  EXPECT_THAT(Refusal({"/camera/depth:=/x"}), HasSubstr("the recording has no such topic"));
  std::filesystem::remove(folder_ / "run.mcap");
  EXPECT_THAT(Refusal({"/camera/camera/depth/image_rect_raw:=/camera/depth/image_rw"}),
              HasSubstr("did you mean '/camera/depth/image_raw'?"));
}

TEST_F(MakeExperimentTest, PlayedRecordingsKeepTheirNamesAndTimes) {
  // Both begin at 0 and have the same stamps.
  std::int64_t log_ns = kStart_ns;
  for (const char* name : {"a", "b"}) {
    for (int i = 0; i < 3; ++i, log_ns += kStep_ns) {
      Cdr markers;
      markers.Stamp(i * kStep_ns, "robot").Put(std::uint64_t(i)).Text(name).Put(std::uint8_t{1});
      markers.Array<double>(std::vector<double>(5));  // an exact pose
      markers.Put(std::uint32_t{1}).Text("m").Array<double>({0.1, 0.2, 0.1 * i, 1e-3, 1e-3, 1e-3});
      markers.Array<double>(std::vector<double>(9)).Put(std::uint8_t{1});
      messages_.Add("/perception/markers", "palpate_msgs/msg/MarkerArray3", log_ns, markers);
      Cdr joints;
      joints.Stamp(i * kStep_ns, "").Put(std::uint32_t{1}).Text("north");
      joints.List<double>({0.01 * i}).List<double>({}).List<double>({name[0] == 'a' ? 1.0 : 2.0});
      messages_.Add("/robot/joint_states", "sensor_msgs/msg/JointState", log_ns, joints);
    }
  }
  const auto experiment = Make();
  ASSERT_EQ(experiment.recordings.size(), 2u);
  EXPECT_EQ(experiment.markers_sigma_m, Eigen::Vector3d::Constant(1e-3));
  for (const std::size_t r : {0u, 1u}) {
    const auto& recording = experiment.recordings[r];
    EXPECT_EQ(recording.name, r == 0 ? "a" : "b");
    EXPECT_THAT(recording.actuation->t_s, ElementsAre(0.0, 0.1, 0.2));
    EXPECT_EQ(recording.actuation->columns[1].samples[2], r == 0 ? 1.0 : 2.0);
    ASSERT_EQ(recording.markers->frames.size(), 3u);
    EXPECT_EQ(recording.markers->frames[2].positions_m[0], Eigen::Vector3d(0.1, 0.2, 0.2));
    ASSERT_TRUE(recording.reference);
    EXPECT_EQ(recording.reference->window_s.end_s, 0.2);
  }
}

TEST_F(MakeExperimentTest, StampsOfTwoClocksAreReplacedByTheTimesOfRecording) {
  AddDepthInfo();
  for (int i = 0; i < 3; ++i) AddDepth(i);
  Cdr cdr;
  cdr.Stamp(5'000'000'000, "").Put(std::uint32_t{1}).Text("north");
  cdr.List<double>({0.1}).List<double>({}).List<double>({});
  messages_.Add("/robot/joint_states", "sensor_msgs/msg/JointState", kStart_ns + kStep_ns, cdr);
  const auto experiment = Make();
  EXPECT_THAT(Notes(), HasSubstr("of another clock"));
  EXPECT_THAT(experiment.recordings.front().actuation->t_s, ElementsAre(0.1));
}

TEST_F(MakeExperimentTest, ImagesOfOneStampAreOne) {
  AddDepthInfo();
  AddDepth(0);
  AddDepth(0);
  AddDepth(1);
  EXPECT_EQ(Make().recordings.front().depth_images.size(), 2u);
  EXPECT_THAT(Notes(), HasSubstr("1 image(s) or marker frame(s) have the time of one before"));
}

TEST(MakeExperimentOfRos2, ARecordingWithoutIntrinsicsIsRefusedWithTheReason) {
  const auto file = test_support::MeasuredDataFolder() / "ros2/ros2_humble_image_wrench.mcap";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << " (set PALPATE_DATA_DIR)";
  const TestFolder folder;
  EXPECT_THAT(
      MessageOf([&] { offline::MakeExperiment(file, {}, {}, folder / "out", app::LoadYaml); }),
      HasSubstr("/camera/depth/image_raw: no intrinsics"));
}

}  // namespace
}  // namespace palpate::command
