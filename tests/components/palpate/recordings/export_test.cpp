// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

#include "components/palpate/recordings/export_messages.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/cloud/ply.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"
#include "libs/recording/writer.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/components/palpate/recordings/cdr_writer.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

/// A recording of messages, one each 0.5 s.
class Export : public testing::Test {
 protected:
  void Add(const std::string& topic, const std::string& type, const Cdr& cdr) {
    if (!writer_) {
      writer_.emplace(std::make_unique<recording::OutputFile>(folder_ / "run.mcap"),
                      recording::WriterOptions());
    }
    const std::uint16_t schema = writer_->AddSchema(
        type, "ros2msg", FormatRos2msg(type, recording::BuiltInDefinitions()).value());
    const std::uint16_t channel = writer_->AddChannel(
        {.id = 0, .schema_id = schema, .topic = topic, .message_encoding = "cdr", .metadata = {}});
    time_ns_ += 500'000'000;
    writer_->Write(recording::Message{channel, 0, time_ns_, time_ns_, cdr.bytes()});
  }

  std::vector<ExportedTopic> Run(CloudFormat clouds = CloudFormat::kPly,
                                 const std::vector<std::string>& topics = {}) {
    writer_->Close();
    std::filesystem::create_directories(out_);
    return ExportMessages(recording::RecordedMessages({folder_ / "run.mcap"}),
                          {out_, topics, clouds});
  }

  const TestFolder folder_;
  const std::filesystem::path out_ = folder_ / "out";
  std::optional<recording::Writer> writer_;
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST_F(Export, ATopicBecomesATableWithUnitsAndEmptyFieldsForWhatIsMissing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {0.25, nan}) {
    Cdr cdr;
    cdr.Header(7, 5).Put(std::uint32_t{2}).Text("north").Text("a, \"b\"");
    cdr.List<double>({value, 2.0}).List<double>({}).List<double>({1.5, -3.0});
    Add("/robot/joint_states", "sensor_msgs/msg/JointState", cdr);
  }
  const auto told = Run();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].messages, 2u);
  EXPECT_EQ(ReadFile(out_ / "robot_joint_states.csv"),
            "t_s,log_time_ns,header.stamp_ns,header.frame_id,name[0],name[1],position_m[0],"
            "position_m[1],effort_N[0],effort_N[1]\n"
            "0,1500000000,7000000005,frame,north,\"a, \"\"b\"\"\",0.25,2,1.5,-3\n"
            "0.5,2000000000,7000000005,frame,north,\"a, \"\"b\"\"\",,2,1.5,-3\n");
}

TEST_F(Export, DepthAndColourBecomePictures) {
  const auto image = [](const std::string& encoding, std::uint32_t step,
                        const std::vector<std::uint8_t>& data) {
    Cdr cdr;
    cdr.Header(1, 2).Put(std::uint32_t{1}).Put(std::uint32_t{2}).Text(encoding);
    cdr.Put(std::uint8_t{0}).Put(step).List(data);
    return cdr;
  };
  // The rows of this one have padding.
  Add("/depth", "sensor_msgs/msg/Image", image("16UC1", 6, {1, 2, 3, 4, 0, 0}));
  Add("/bgr", "sensor_msgs/msg/Image", image("bgr8", 6, {1, 2, 3, 4, 5, 6}));
  Add("/other", "sensor_msgs/msg/Image", image("32FC4", 32, std::vector<std::uint8_t>(32)));
  Add("/short", "sensor_msgs/msg/Image", image("16UC1", 4, {1, 2}));
  const auto told = Run();
  EXPECT_EQ(rgbd::ReadDepthPng(out_ / "depth/1000000002.png").values,
            (std::vector<std::uint16_t>{0x0201, 0x0403}));
  EXPECT_EQ(rgbd::ReadColorPng(out_ / "bgr/1000000002.png").values,
            (std::vector<std::uint8_t>{3, 2, 1, 6, 5, 4}));
  EXPECT_THAT(told[2].reason, HasSubstr("encoding '32FC4' is not known"));
  EXPECT_EQ(told[2].left_out, 1u);
  EXPECT_EQ(told[3].reason, "is no whole image");
}

TEST_F(Export, ACloudBecomesAFileOfEachFormat) {
  Cdr cdr;
  cdr.Header(3, 0).Put(std::uint32_t{1}).Put(std::uint32_t{2}).Put(std::uint32_t{4});
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "rgb"}) {
    cdr.Text(name).Put(offset).Put(std::uint8_t{7}).Put(std::uint32_t{1});
    offset += 4;
  }
  std::vector<std::uint8_t> data(32);
  const std::array<float, 3> first{0.5f, -1.0f, 2.0f};
  std::memcpy(data.data(), first.data(), sizeof(first));
  data[14] = 200;  // red of 0x00RRGGBB
  cdr.Put(std::uint8_t{0}).Put(std::uint32_t{16}).Put(std::uint32_t{32}).List(data);
  Add("/cloud", "sensor_msgs/msg/PointCloud2", cdr);
  writer_->Close();
  const recording::RecordedMessages reader({folder_ / "run.mcap"});
  for (const CloudFormat format : {CloudFormat::kPly, CloudFormat::kPcd}) {
    ASSERT_EQ(ExportMessages(reader, {out_, {}, format})[0].messages, 1u);
  }
  for (const auto& cloud : {experiment::ReadPly(out_ / "cloud/3000000000.ply"),
                            experiment::ReadPcd(out_ / "cloud/3000000000.pcd")}) {
    ASSERT_EQ(cloud.points_m.cols(), 2);
    EXPECT_EQ(cloud.points_m.col(0), Eigen::Vector3d(0.5, -1.0, 2.0));
    EXPECT_EQ(cloud.colors_rgb[0], 200);
  }
}

TEST_F(Export, MeshStatesBecomeASeriesForParaView) {
  const auto state = [](const std::string& hash, std::uint32_t stamp_s) {
    Cdr cdr;
    cdr.Header(static_cast<std::int32_t>(stamp_s), 0).Put(std::uint64_t{1}).Text(hash).Text("ok");
    return cdr.List<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1.5f});
  };
  Cdr mesh;
  mesh.Header(0, 0).Text("tet").Text("hash").Text("tet4").Put(std::uint8_t{4});
  mesh.List<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}).List<std::uint32_t>({0, 1, 2, 3});
  mesh.List<std::uint32_t>({});
  Add("/robot/mesh_state", "palpate_msgs/msg/MeshState", state("hash", 1));
  Add("/robot/mesh", "palpate_msgs/msg/Mesh", mesh);
  Add("/robot/mesh_state", "palpate_msgs/msg/MeshState", state("hash", 2));
  Add("/robot/mesh_state", "palpate_msgs/msg/MeshState", state("another", 3));
  const auto told = Run(CloudFormat::kPly, {"/robot/mesh_state"});
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].messages, 2u);
  EXPECT_THAT(told[0].reason, HasSubstr("its mesh (another) was not recorded"));
  const fem::TetMesh read = fem::ReadMesh(out_ / "robot_mesh_state/1000000000.vtu", 1.0);
  EXPECT_EQ(read.NodeCount(), 4);
  EXPECT_THAT(ReadFile(out_ / "robot_mesh_state/1000000000.vtu"), HasSubstr("displacement_m"));
  EXPECT_THAT(ReadFile(out_ / "robot_mesh_state/body.pvd"),
              HasSubstr("timestep=\"1\" part=\"0\" file=\"2000000000.vtu\""));
}

TEST_F(Export, ATopicThatIsNotThereIsRefused) {
  Add("/robot/joint_states", "sensor_msgs/msg/JointState", Cdr());
  EXPECT_THAT(
      MessageOf([&] { Run(CloudFormat::kPly, {"/robot/joint_state"}); }),
      HasSubstr("unknown topic '/robot/joint_state' (did you mean '/robot/joint_states'?)"));
}

TEST_F(Export, MessagesThatDoNotFitTheirDefinitionAreLeftOutAndTold) {
  Add("/robot/joint_states", "sensor_msgs/msg/JointState", Cdr().Put(std::uint8_t{1}));
  const auto told = Run();
  EXPECT_EQ(told[0].messages, 0u);
  EXPECT_EQ(told[0].left_out, 1u);
  EXPECT_EQ(told[0].reason, "does not fit the definition of its type");
}

TEST(ExportOfRos2, ItsMessagesAreExportedAndAnImageWithoutRowsIsTold) {
  const auto file = test_support::MeasuredDataFolder() / "ros2/ros2_humble_image_wrench.mcap";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << " (set PALPATE_DATA_DIR)";
  const TestFolder folder;
  const recording::RecordedMessages reader({file});
  const ExportOptions options{folder.path(), {"rt/force", "rt/camera/depth/image_raw"}, {}};
  for (const ExportedTopic& topic : ExportMessages(reader, options)) {
    if (topic.topic == "rt/force") {
      EXPECT_EQ(topic.messages, 60u) << topic.reason;
      EXPECT_THAT(ReadFile(topic.target), HasSubstr("wrench.force_N.x,wrench.force_N.y"));
    } else {
      // Its writer counted in the field height, from 0.
      EXPECT_EQ(topic.messages, 59u);
      EXPECT_EQ(topic.left_out, 1u);
      EXPECT_EQ(topic.reason, "is empty: 848 x 0");
    }
  }
}

}  // namespace
}  // namespace palpate::command
