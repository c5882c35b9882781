// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "components/offline/messages/make_experiment.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/recording/compression.hpp"
#include "libs/rgbd/jpeg.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/components/palpate/recordings/topic_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr char kPacked[] = "sensor_msgs/msg/CompressedImage";

/// What image_transport puts in front of the PNG of depth: a format, and the two numbers of
/// z = a / (value - b).
std::string DepthHeader(float a, float b) {
  std::string header(4, '\0');
  for (const float number : {a, b}) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    for (int shift = 0; shift < 32; shift += 8) header += static_cast<char>(bits >> shift);
  }
  return header;
}

enum class Bytes { kLittle, kBig };

template <typename Number>
void Append(Number number, Bytes order, std::vector<std::uint8_t>* data) {
  auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(Number)>>(number);
  if (order == Bytes::kBig) std::reverse(bytes.begin(), bytes.end());
  data->insert(data->end(), bytes.begin(), bytes.end());
}

/// x, y, z of each pixel of a cloud of `width` columns; each row ends with `padding` bytes.
template <typename Number>
Cdr CloudMessage(std::int64_t t_ns, const std::vector<std::array<Number, 3>>& points,
                 std::uint32_t width, std::uint32_t padding, Bytes order) {
  constexpr std::uint8_t kDatatype = sizeof(Number) == 8 ? 8 : 7;
  constexpr std::uint32_t kSize = sizeof(Number);
  std::vector<std::uint8_t> data;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Number number : points[i]) Append(number, order, &data);
    if ((i + 1) % width == 0) data.insert(data.end(), padding, 0xEE);
  }
  Cdr cdr;
  cdr.Stamp(t_ns, "optical").Put(static_cast<std::uint32_t>(points.size() / width)).Put(width);
  cdr.Put(std::uint32_t{3});
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z"}) {
    cdr.Text(name).Put(offset).Put(kDatatype).Put(std::uint32_t{1});
    offset += kSize;
  }
  cdr.Put(std::uint8_t{order == Bytes::kBig}).Put(3 * kSize).Put(3 * kSize * width + padding);
  return cdr.List(data).Put(std::uint8_t{0});
}

/// A recording in a format that drivers use, and the experiment that it becomes.
class RecordedFormats : public testing::Test {
 protected:
  void AddInfo(const std::string& topic, std::int64_t t_ns = kStart_ns, double focal_px = 10.0) {
    messages_.Add(topic, "sensor_msgs/msg/CameraInfo", t_ns,
                  CameraInfoMessage("optical", 2, 2, "plumb_bob", {0, 0, 0, 0, 0}, focal_px));
  }
  void AddDepth(int index = 0) {
    const std::int64_t t_ns = kStart_ns + index * kStep_ns;
    messages_.Add("/camera/depth/image_raw", "sensor_msgs/msg/Image", t_ns,
                  ImageMessage(t_ns, "optical", 2, 2, "16UC1", 4, {1, 1, 2, 0, 3, 0, 255, 255}));
  }
  void AddPacked(const std::string& topic, const std::string& format, const std::string& data) {
    Cdr cdr;
    cdr.Stamp(kStart_ns, "optical").Text(format);
    messages_.Add(topic, kPacked, kStart_ns, cdr.List(std::vector<char>(data.begin(), data.end())));
  }
  void AddPackedDepth(const std::string& format, const std::string& header) {
    AddInfo("/camera/depth/camera_info");
    AddPacked("/camera/depth/image_raw/compressedDepth", format, header + DepthPng());
  }
  std::string DepthPng() const {
    rgbd::DepthImage image(2, 2);
    image.values = {19191, 0, 9091, 19300};
    rgbd::WriteDepthPng(folder_ / "depth.png", image);
    return ReadFile(folder_ / "depth.png");
  }
  /// Colour beside depth of the same camera, as a driver packs it.
  void AddPackedColor(const std::string& format, const std::string& data) {
    AddInfo("/camera/depth/camera_info");
    AddInfo("/camera/color/camera_info");
    AddDepth();
    AddPacked("/camera/color/image_raw/compressed", format, data);
  }
  static rgbd::ColorImage Orange() {
    rgbd::ColorImage image(2, 2);
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      image.values[i] = std::array<std::uint8_t, 3>{200, 120, 40}[i % 3];
    }
    return image;
  }
  void AddAttachment(const std::string& name, const std::string& data) {
    messages_.attachments.push_back({.log_time_ns = kStart_ns,
                                     .create_time_ns = kStart_ns,
                                     .name = name,
                                     .media_type = "text/plain",
                                     .data = data});
  }

  experiment::Experiment MakeOf(const std::filesystem::path& file) {
    notes_.clear();
    for (const std::string& note : offline::MakeExperiment(file, {}, {}, out_, app::LoadYaml)) {
      notes_ += note + "\n";
    }
    return experiment::ReadExperiment(out_, app::LoadYaml);
  }
  experiment::Experiment Make() {
    messages_.WriteMcap(folder_ / "run.mcap");
    return MakeOf(folder_ / "run.mcap");
  }
  rgbd::RgbdCamera Camera() const {
    return rgbd::ReadCameraFile(out_ / "recordings/run/camera.yaml", app::LoadYaml);
  }
  experiment::PointCloud Cloud() const {
    return experiment::ReadPcd(out_ / "recordings/run/clouds/0.pcd");
  }

  const TestFolder folder_;
  const std::filesystem::path out_ = folder_ / "experiment";
  const std::filesystem::path depth_file_ = out_ / "recordings/run/depth/0.png";
  const std::filesystem::path color_file_ = out_ / "recordings/run/color/0.png";
  TopicRecording messages_;
  std::string notes_;
};

TEST_F(RecordedFormats, CompressedDepthOfStepsIsKeptBitForBit) {
  AddPackedDepth("16UC1; compressedDepth png", DepthHeader(0, 0));
  Make();
  EXPECT_THAT(rgbd::ReadDepthPng(depth_file_).values, ElementsAre(19191, 0, 9091, 19300));
  EXPECT_EQ(Camera().depth_unit_m, 0.001);
}

TEST_F(RecordedFormats, CompressedDepthOfMetresIsUnpackedByItsHeader) {
  // Of the parameters depth_quantization 100 and depth_max 10 m.
  AddPackedDepth("32FC1; compressedDepth", DepthHeader(10100.0f, -1009.0f));
  Make();
  EXPECT_EQ(Camera().depth_unit_m, 0.0001);
  EXPECT_THAT(rgbd::ReadDepthPng(depth_file_).values, ElementsAre(5000, 0, 10000, 4973));
}

TEST_F(RecordedFormats, CompressedDepthWithoutItsHeaderIsLeftOutAndTold) {
  AddDepth(1);
  AddPackedDepth("32FC1; compressedDepth png", "");
  Make();
  EXPECT_FALSE(std::filesystem::exists(depth_file_)) << "the raw topic is better";
  messages_.entries.clear();
  std::filesystem::remove(folder_ / "run.mcap");
  AddPackedDepth("32FC1; compressedDepth png", "");
  EXPECT_THAT(MessageOf([&] { Make(); }),
              HasSubstr("1 message(s) of /camera/depth/image_raw/compressedDepth: PNG: "));
}

TEST_F(RecordedFormats, RvlIsRefusedWithTheRemedy) {
  AddPackedDepth("16UC1; compressedDepth rvl", DepthHeader(0, 0));
  EXPECT_THAT(MessageOf([&] { Make(); }),
              HasSubstr("is packed as RVL, which is not read; take PNG"));
}

TEST_F(RecordedFormats, PackedColourGoesWithDepth) {
  AddPackedColor("bgr8; png compressed bgr8", rgbd::EncodeColorPng(Orange(), 1));
  Make();
  EXPECT_EQ(rgbd::ReadColorPng(color_file_).values, Orange().values);
  EXPECT_TRUE(Camera().color_registered);
}

TEST_F(RecordedFormats, JpegColourIsRedGreenBlue) {
  AddPackedColor("rgb8; jpeg compressed bgr8", rgbd::EncodeJpeg(Orange(), 100));
  Make();
  const auto values = rgbd::ReadColorPng(color_file_).values;
  ASSERT_EQ(values.size(), Orange().values.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], Orange().values[i], 3);
}

TEST_F(RecordedFormats, ADamagedJpegIsLeftOutAndTold) {
  AddPackedColor("rgb8; jpeg compressed bgr8", rgbd::EncodeJpeg(Orange(), 100).substr(0, 40));
  Make();
  EXPECT_FALSE(std::filesystem::exists(color_file_));
  EXPECT_THAT(notes_, HasSubstr("left out: 1 message(s) of /camera/color/image_raw/compressed: "
                                "JPEG: is a damaged JPEG image"));
}

TEST_F(RecordedFormats, AnOrganisedCloudKeepsItsRowsAndItsGaps) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  AddInfo("/camera/depth/camera_info");
  messages_.Add(
      "/camera/points", "sensor_msgs/msg/PointCloud2", kStart_ns,
      CloudMessage<float>(kStart_ns, {{0, 1, 2}, {nan, nan, nan}, {0.5f, -1, 3}, {1, 2, 4}}, 2, 5,
                          Bytes::kLittle));
  Make();
  const auto cloud = Cloud();
  EXPECT_EQ(cloud.width, 2);
  EXPECT_EQ(cloud.height, 2);
  ASSERT_EQ(cloud.points_m.cols(), 4);
  EXPECT_TRUE(std::isnan(cloud.points_m(2, 1)));
  EXPECT_EQ(cloud.points_m.col(2), Eigen::Vector3d(0.5, -1, 3));
  EXPECT_EQ(cloud.points_m.col(3), Eigen::Vector3d(1, 2, 4));
}

TEST_F(RecordedFormats, CloudsOfEitherPrecisionAndByteOrderAreTheSame) {
  const std::vector<Cdr> clouds{
      CloudMessage<double>(kStart_ns, {{0.5, -1, 3}, {1, 2, 4}}, 2, 0, Bytes::kLittle),
      CloudMessage<double>(kStart_ns, {{0.5, -1, 3}, {1, 2, 4}}, 2, 0, Bytes::kBig),
      CloudMessage<float>(kStart_ns, {{0.5f, -1, 3}, {1, 2, 4}}, 2, 0, Bytes::kBig)};
  for (const Cdr& cloud : clouds) {
    messages_.entries.clear();
    std::filesystem::remove_all(out_);
    std::filesystem::remove(folder_ / "run.mcap");
    AddInfo("/camera/depth/camera_info");
    messages_.Add("/camera/points", "sensor_msgs/msg/PointCloud2", kStart_ns, cloud);
    Make();
    ASSERT_EQ(Cloud().points_m.cols(), 2);
    EXPECT_EQ(Cloud().points_m.col(0), Eigen::Vector3d(0.5, -1, 3));
    EXPECT_EQ(Cloud().points_m.col(1), Eigen::Vector3d(1, 2, 4));
  }
}

TEST_F(RecordedFormats, MessagesThatRosbag2PackedAreUnpackedOneByOne) {
  AddInfo("/camera/depth/camera_info");
  AddDepth(0);
  AddDepth(1);
  recording::Compressor zstd(recording::Compression::kZstd, 1);
  const std::string padding(200, '\0');
  for (TopicRecording::Entry& entry : messages_.entries) {
    entry.data += padding;  // what does not get smaller is not packed
    const auto packed = zstd.Pack(entry.data);
    ASSERT_EQ(packed.compression, recording::Compression::kZstd);
    entry.data = packed.bytes;
  }
  messages_.entries.back().data.resize(messages_.entries.back().data.size() - 4);
  messages_.WriteSqlite(folder_ / "run.db3");
  for (const bool sqlite : {false, true}) {
    std::filesystem::remove_all(out_);
    const auto experiment = sqlite ? MakeOf(folder_ / "run.db3") : Make();
    EXPECT_EQ(experiment.recordings.front().depth_images.size(), 1u);
    EXPECT_THAT(rgbd::ReadDepthPng(depth_file_).values, ElementsAre(257, 2, 3, 65535));
    EXPECT_THAT(notes_, HasSubstr("compressed messages are left out: zstd data are damaged"));
  }
}

TEST_F(RecordedFormats, AnAttachedRobotIsThatOfTheExperimentWithItsMesh) {
  AddInfo("/camera/depth/camera_info");
  AddDepth();
  AddAttachment("finger.yaml", "name: finger\nmesh:\n  file: meshes/finger.msh\n");
  AddAttachment("meshes/finger.msh", "a mesh");
  const auto experiment = Make();
  ASSERT_TRUE(experiment.robot);
  EXPECT_EQ(ReadFile(experiment.robot->parent_path() / "meshes/finger.msh"), "a mesh");
}

TEST_F(RecordedFormats, AttachmentsThatLeadOutOfTheirFolderAreLeftOutAndTold) {
  AddInfo("/camera/depth/camera_info");
  AddDepth();
  const std::vector<std::string> names{"../../evil.yaml", "..", (folder_ / "evil.yaml").string(),
                                       "a/../../evil.yaml", ""};
  for (const std::string& name : names) AddAttachment(name, "mesh: evil\n");
  const auto experiment = Make();
  EXPECT_FALSE(experiment.robot);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "evil.yaml"));
  EXPECT_FALSE(std::filesystem::exists(out_ / "evil.yaml"));
  for (const std::string& name : names) {
    EXPECT_THAT(notes_, HasSubstr("attachment '" + name + "' is left out: its name is no path"));
  }
}

TEST_F(RecordedFormats, ACalibrationSaysThePoseOfTheCameraBeforeTransformsDo) {
  AddInfo("/camera/depth/camera_info");
  AddDepth();
  messages_.Add("/tf_static", "tf2_msgs/msg/TFMessage", kStart_ns,
                TransformMessage("robot", "optical", 0.9));
  Cdr cdr;
  cdr.Stamp(kStart_ns, "robot").Text("finger").Text("hash").Text("tet10").Text("neo_hooke");
  cdr.Put(0.45).Text("").Put(0.0).Put(0.0).Text("2026-01-31T12:00:00Z").Text("data").Text("hash");
  cdr.Put(std::uint8_t{1}).Array<double>({0.1, 0.2, 0.3, 0, 0, std::sqrt(0.5), std::sqrt(0.5)});
  std::vector<double> covariance(36);
  const std::array<double, 6> errors{1e-3, 2e-3, 1e-3, 0.01, 0.02, 0.03};
  for (std::size_t i = 0; i < 6; ++i) covariance[7 * i] = errors[i] * errors[i];
  // What stands behind is not read.
  messages_.Add("/calibration", "palpate_msgs/msg/Calibration", kStart_ns, cdr.Array(covariance));
  const auto experiment = Make();
  ASSERT_TRUE(experiment.T_robot_camera);
  EXPECT_EQ(experiment.T_robot_camera->translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
  const Eigen::Vector3d turned = experiment.T_robot_camera->linear() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((turned - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-9);
  ASSERT_TRUE(experiment.T_robot_camera_error);
  EXPECT_NEAR(experiment.T_robot_camera_error->translation_m, 2e-3, 1e-9);
  EXPECT_NEAR(experiment.T_robot_camera_error->rotation_rad, 0.03, 1e-9);
  EXPECT_THAT(notes_, HasSubstr("camera pose of /calibration"));
}

/// A stereo camera with steps of 0.25 mm, whose colour camera stands 15 mm beside.
Cdr SetupMessage(double depth_unit_m) {
  Cdr cdr;
  cdr.Stamp(kStart_ns, "optical").Put(std::uint32_t{1}).Text("maker-1").Text("model");
  cdr.Put(depth_unit_m).Put(std::uint32_t{65535}).Put(0.05).Put(0.1).Put(std::uint8_t{0});
  return cdr.Array<double>({0.015, 0, 0, 0, 0, 0, 1}).Text("hash");
}

TEST_F(RecordedFormats, CameraSetupSaysWhatCameraInfoCannot) {
  AddPackedColor("rgb8; png compressed bgr8", rgbd::EncodeColorPng(Orange(), 1));
  messages_.Add("/camera/setup", "palpate_msgs/msg/CameraSetup", kStart_ns, SetupMessage(0.00025));
  const auto experiment = Make();
  EXPECT_EQ(Camera().depth_unit_m, 0.00025);
  EXPECT_EQ(Camera().invalid_value, 65535);
  EXPECT_EQ(Camera().baseline_m, 0.05);
  EXPECT_FALSE(Camera().color_registered);
  EXPECT_EQ(Camera().T_depth_color.translation(), Eigen::Vector3d(0.015, 0, 0));
  ASSERT_TRUE(experiment.depth_noise);
  EXPECT_EQ(experiment.depth_noise->subpixel_px, 0.1);
}

TEST_F(RecordedFormats, ACameraThatChangesIsRefused) {
  AddInfo("/camera/depth/camera_info", kStart_ns, 10.0);
  AddInfo("/camera/depth/camera_info", kStart_ns + kStep_ns, 12.0);
  AddDepth(0);
  AddDepth(1);
  EXPECT_THAT(MessageOf([&] { Make(); }),
              HasSubstr("/camera/depth/camera_info: the camera changes during the recording: fx is "
                        "10 px, later 12 px; make a recording of each part"));
}

TEST_F(RecordedFormats, ASetupThatChangesIsRefused) {
  AddInfo("/camera/depth/camera_info");
  AddDepth();
  for (const double unit_m : {0.001, 0.00025}) {
    messages_.Add("/camera/setup", "palpate_msgs/msg/CameraSetup", kStart_ns, SetupMessage(unit_m));
  }
  EXPECT_THAT(MessageOf([&] { Make(); }),
              HasSubstr("/camera/setup: the camera changes during the recording: the depth step is "
                        "0.001 m, later 0.00025 m; make a recording of each part"));
}

TEST_F(RecordedFormats, CameraInfoBeforeTheCameraIsCalibratedDoesNotCount) {
  AddInfo("/camera/depth/camera_info", kStart_ns, 0.0);
  AddInfo("/camera/depth/camera_info", kStart_ns + kStep_ns, 12.0);
  AddDepth(0);
  Make();
  EXPECT_EQ(Camera().depth.fx_px, 12.0);
}

}  // namespace
}  // namespace palpate::command
