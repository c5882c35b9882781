// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/images/rgbd_sequence.hpp"

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/cloud/ply.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

namespace fs = std::filesystem;

rgbd::RgbdCamera Camera() {
  rgbd::RgbdCamera camera;
  camera.depth = {4, 3, 5.0, 5.0, 1.5, 1.0, {}};
  camera.depth_unit_m = 0.001;
  camera.color = camera.depth;
  camera.color_registered = true;
  return camera;
}

rgbd::DepthImage Depth(std::uint16_t first) {
  rgbd::DepthImage image(4, 3, 1000);
  image.values[0] = first;
  return image;
}

class RgbdSequenceTest : public testing::Test {
 protected:
  void Depth_(const std::string& name, std::uint16_t first) const {
    fs::create_directories((folder_.path() / name).parent_path());
    rgbd::WriteDepthPng(folder_.path() / name, Depth(first));
  }
  void Color_(const std::string& name, std::uint8_t value) const {
    fs::create_directories((folder_.path() / name).parent_path());
    rgbd::WriteColorPng(folder_.path() / name, rgbd::ColorImage(4, 3, value));
  }
  void WriteRecordingOf(const std::string& name, int first) const {
    folder_.Write(name + "/recording.yaml", "kind: free\n");
    folder_.Write(name + "/camera.yaml", rgbd::FormatCameraFile(Camera()));
    for (int i = first; i < first + 2; ++i) {
      Depth_(name + "/depth/" + std::to_string(i) + "000000.png", static_cast<std::uint16_t>(i));
      Color_(name + "/color/" + std::to_string(i) + "000000.png", static_cast<std::uint8_t>(i));
    }
  }
  std::vector<RgbdSequence> Open(const std::string& name = "") const {
    return OpenRgbdSequences(folder_.path() / name, app::LoadYaml);
  }
  std::string Refusal(const std::string& name = "") const {
    return MessageOf([&] { Open(name); });
  }

  TestFolder folder_;
};

TEST_F(RgbdSequenceTest, ReadsTheFramesOfARecordingByTime) {
  WriteRecordingOf("r", 7);
  const auto sequences = Open("r");
  ASSERT_THAT(sequences, SizeIs(1));
  EXPECT_EQ(sequences[0].name, "r");
  EXPECT_EQ(sequences[0].camera.depth, Camera().depth);
  ASSERT_THAT(sequences[0].frames, SizeIs(2));
  rgbd::RgbdFrame frame;
  sequences[0].Read(1, &frame);
  EXPECT_EQ(frame.stamp_ns, 8000000);
  EXPECT_EQ(frame.depth, Depth(8));
  EXPECT_EQ(frame.color, rgbd::ColorImage(4, 3, 8));
}

TEST_F(RgbdSequenceTest, ADepthImageMayDoWithoutColour) {
  WriteRecordingOf("r", 7);
  fs::remove(folder_.path() / "r/color/7000000.png");
  const auto sequences = Open("r");
  rgbd::RgbdFrame frame;
  sequences[0].Read(1, &frame);
  EXPECT_FALSE(frame.color.empty());
  sequences[0].Read(0, &frame);
  EXPECT_EQ(frame.stamp_ns, 7000000);
  EXPECT_TRUE(frame.color.empty());
}

TEST_F(RgbdSequenceTest, AnExperimentGivesTheRecordingsThatHoldImages) {
  folder_.Write("experiment.yaml", "frame: camera\n");
  WriteRecordingOf("recordings/a", 1);
  folder_.Write("recordings/b/recording.yaml", "kind: rest\n");
  WriteRecordingOf("recordings/c", 5);
  const auto sequences = Open();
  ASSERT_THAT(sequences, SizeIs(2));
  EXPECT_EQ(sequences[0].name, "a");
  EXPECT_EQ(sequences[1].frames[0].t_ns, 5000000);
}

TEST_F(RgbdSequenceTest, RefusesAColourImageWithoutDepth) {
  WriteRecordingOf("r", 7);
  for (const char* stray : {"5000000", "9000000"}) {
    Color_(std::string("r/color/") + stray + ".png", 1);
    EXPECT_THAT(Refusal("r"), AllOf(HasSubstr(std::string(stray) + ".png"),
                                    HasSubstr("no depth image of the same name")));
    fs::remove(folder_.path() / "r/color" / (std::string(stray) + ".png"));
  }
}

TEST_F(RgbdSequenceTest, RefusesImagesWithoutACameraOrOfAnotherSize) {
  WriteRecordingOf("r", 7);
  rgbd::WriteDepthPng(folder_.path() / "r/depth/7000000.png", rgbd::DepthImage(5, 3, 9));
  rgbd::WriteColorPng(folder_.path() / "r/color/8000000.png", rgbd::ColorImage(4, 4, 9));
  const RgbdSequence sequence = Open("r")[0];
  rgbd::RgbdFrame frame;
  EXPECT_THAT(MessageOf([&] { sequence.Read(0, &frame); }),
              AllOf(HasSubstr("7000000.png"), HasSubstr("is 5 x 3 pixels, its camera has 4 x 3")));
  EXPECT_THAT(MessageOf([&] { sequence.Read(1, &frame); }), HasSubstr("is 4 x 4 pixels"));
  rgbd::RgbdCamera no_color = Camera();
  no_color.color.width_px = 0;
  folder_.Write("r/camera.yaml", rgbd::FormatCameraFile(no_color));
  EXPECT_THAT(MessageOf([&] { Open("r")[0].Read(1, &frame); }), HasSubstr("has no 'color'"));
  fs::remove(folder_.path() / "r/camera.yaml");
  EXPECT_THAT(Refusal("r"), HasSubstr("has no camera.yaml"));
}

TEST_F(RgbdSequenceTest, RefusesFoldersWithoutImages) {
  folder_.Write("r/recording.yaml", "kind: rest\n");
  EXPECT_THAT(Refusal("r"), HasSubstr("holds neither depth images nor clouds"));
  EXPECT_THAT(Refusal(), HasSubstr("is neither an experiment"));
  EXPECT_THAT(Refusal("none"), HasSubstr("is no folder"));
}

TEST_F(RgbdSequenceTest, PairsTheImagesOfATumFolderByNearestTime) {
  for (int i = 0; i < 4; ++i)
    Depth_("depth/" + std::to_string(i) + ".png", static_cast<std::uint16_t>(i));
  for (int i = 0; i < 3; ++i)
    Color_("rgb/" + std::to_string(i) + ".png", static_cast<std::uint8_t>(i));
  folder_.Write("camera.yaml", rgbd::FormatCameraFile(Camera()));
  // The second colour image is 15 ms after depth 1 and 5 ms before depth 2: 2 gets it. Depth 3 is
  // 21 ms from the last.
  folder_.Write("depth.txt",
                "# time file\n1305031453.374112 depth/0.png\n1305031453.400000 depth/1.png\n"
                "1305031453.420 depth/2.png\n1305031453.521 depth/3.png\n");
  folder_.Write("rgb.txt",
                "1305031453.359684 rgb/0.png\n1305031453.415 rgb/1.png\n"
                "1305031453.500 rgb/2.png\n");
  const auto sequences = Open();
  ASSERT_THAT(sequences, SizeIs(1));
  const RgbdSequence& sequence = sequences[0];
  ASSERT_THAT(sequence.frames, SizeIs(2));
  EXPECT_EQ(sequence.unpaired, 2u);
  EXPECT_THAT(sequence.notes, ElementsAre(HasSubstr("2 depth images without a colour image")));
  EXPECT_EQ(sequence.frames[0].t_ns, 1305031453374112000);
  EXPECT_EQ(sequence.frames[1].t_ns, 1305031453420000000);
  rgbd::RgbdFrame frame;
  sequence.Read(1, &frame);
  EXPECT_EQ(frame.depth.values[0], 2);
  EXPECT_EQ(frame.color.values[0], 1);
}

TEST_F(RgbdSequenceTest, ATumFolderHasTheBenchmarksCameraUnlessItSays) {
  folder_.Write("depth.txt", "1.5 depth/0.png\n");
  const RgbdSequence sequence = Open()[0];
  EXPECT_EQ(sequence.camera.depth.fx_px, 525.0);
  EXPECT_EQ(sequence.camera.depth_unit_m, 1.0 / 5000.0);
  EXPECT_EQ(sequence.frames[0].t_ns, 1500000000);
  EXPECT_TRUE(sequence.frames[0].color.empty());
}

TEST_F(RgbdSequenceTest, RefusesBrokenTumLists) {
  const auto refusal = [&](const std::string& depth) {
    folder_.Write("depth.txt", depth);
    return Refusal();
  };
  EXPECT_THAT(refusal("1.0 a.png\nx b.png\n"), AllOf(HasSubstr("depth.txt:2:1"), HasSubstr("'x'")));
  EXPECT_THAT(refusal("-1.0 a.png\n"), HasSubstr("is no time"));
  EXPECT_THAT(refusal("1.0 a.png\n1.0 b.png\n"), HasSubstr("time must rise"));
  EXPECT_THAT(refusal("1.0\n"), HasSubstr("a time and a file name"));
  EXPECT_THAT(refusal("1.0 a b\n"), HasSubstr("a time and a file name"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("names no image"));
  folder_.Write("rgb.txt", "9.0 c.png\n");
  EXPECT_THAT(refusal("1.0 a.png\n"), HasSubstr("within 20 ms"));
}

TEST_F(RgbdSequenceTest, MakesDepthImagesOfClouds) {
  PointCloud organised;
  organised.width = 4;
  organised.height = 3;
  organised.points_m = Eigen::Matrix3Xd::Constant(3, 12, 0.5);
  organised.points_m.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  organised.points_m(2, 2) = 70.0;  // farther than 65535 mm
  organised.colors_rgb.assign(36, 200);
  WritePcd(organised, folder_.path() / "5000000.pcd");
  PointCloud loose;
  loose.width = 4;
  loose.points_m.resize(3, 4);
  loose.points_m << 0.05, 0.1, 9, 0.0,  // the first hides the second, the third is out of view
      0, 0, 0, 0,                       //
      0.5, 1, 1, -1;
  WritePly(loose, folder_.path() / "9000000.ply");
  folder_.Write("camera.yaml", rgbd::FormatCameraFile(Camera()));
  const RgbdSequence sequence = Open()[0];
  rgbd::RgbdFrame frame;
  sequence.Read(0, &frame);
  EXPECT_EQ(frame.stamp_ns, 5000000);
  EXPECT_THAT(frame.depth.values,
              ElementsAre(500, 0, 0, 500, 500, 500, 500, 500, 500, 500, 500, 500));
  EXPECT_EQ(frame.color.Pixel(0, 0)[1], 200);
  EXPECT_EQ(frame.color.Pixel(1, 0)[1], 0);
  sequence.Read(1, &frame);
  EXPECT_THAT(frame.depth.values, ElementsAre(0, 0, 0, 0, 0, 0, 500, 0, 0, 0, 0, 0));
  EXPECT_TRUE(frame.color.empty());
}

TEST_F(RgbdSequenceTest, RefusesCloudsWithoutATimeOrACamera) {
  PointCloud cloud;
  cloud.points_m.resize(3, 0);
  cloud.height = 1;
  WritePcd(cloud, folder_.path() / "5000000.pcd");
  EXPECT_THAT(Refusal(), HasSubstr("has no camera.yaml"));
  WritePcd(cloud, folder_.path() / "scan.pcd");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("scan.pcd"), HasSubstr("nanoseconds")));
}

}  // namespace
}  // namespace palpate::experiment
