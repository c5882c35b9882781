// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/ros_camera_info.hpp"

#include "libs/app/yaml.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::rgbd {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

RgbdCamera Read(const std::string& text) {
  const TestFolder folder;
  return ReadCameraFile(folder.Write("camera.yaml", text), app::LoadYaml);
}

/// As camera_calibration writes it.
std::string Calibration(const std::string& model, const std::string& distortion) {
  return "image_width: 640\nimage_height: 480\ncamera_name: depth\ncamera_matrix:\n  rows: 3\n"
         "  cols: 3\n  data: [610.5, 0.0, 320.25, 0.0, 612.0, 239.5, 0.0, 0.0, 1.0]\n"
         "distortion_model: " +
         model + "\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: " + distortion + "\n";
}

TEST(RosCameraInfo, IsReadAsCameraCalibrationWritesIt) {
  const RgbdCamera camera =
      Read(Calibration("plumb_bob", "[0.1, -0.2, 0.001, 0.002, 0.05]") + "unit_m: 0.001\n");
  EXPECT_EQ(camera.depth.width_px, 640);
  EXPECT_EQ(camera.depth.height_px, 480);
  EXPECT_EQ(camera.depth.fx_px, 610.5);
  EXPECT_EQ(camera.depth.fy_px, 612.0);
  EXPECT_EQ(camera.depth.cx_px, 320.25);
  EXPECT_EQ(camera.depth.cy_px, 239.5);
  EXPECT_EQ(camera.depth.distortion, (Distortion{0.1, -0.2, 0.001, 0.002, 0.05}));
  EXPECT_EQ(camera.depth_unit_m, 0.001);
}

TEST(RosCameraInfo, IsReadAsAMessageIsPrinted) {
  const RgbdCamera camera = Read(
      "header: {frame_id: depth}\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\nd: []\n"
      "k: [610.5, 0, 320.25, 0, 612, 239.5, 0, 0, 1]\nunit_m: 0.0001\n");
  EXPECT_EQ(camera.depth.fx_px, 610.5);
  EXPECT_FALSE(camera.depth.distorted());
}

TEST(RosCameraInfo, ImagesThatAreBinnedOrCutAreRefused) {
  const std::string whole = Calibration("plumb_bob", "[0, 0, 0, 0, 0]") + "unit_m: 0.001\n";
  EXPECT_EQ(Read(whole + "binning_x: 0\nbinning_y: 1\nroi: {x_offset: 0, y_offset: 0, width: 0}\n")
                .depth.width_px,
            640);
  EXPECT_THAT(MessageOf([&] { Read(whole + "binning_y: 2\n"); }),
              HasSubstr("the images are binned"));
  EXPECT_THAT(MessageOf([&] { Read(whole + "roi: {x_offset: 8, y_offset: 0}\n"); }),
              HasSubstr("a part of the sensor's"));
}

TEST(RosCameraInfo, DistortionMayHaveFourFiveOrEightNumbers) {
  const auto distortion = [](const std::string& model, const std::string& numbers) {
    return Read(Calibration(model, numbers) + "unit_m: 0.001\n").depth.distortion;
  };
  EXPECT_EQ(distortion("plumb_bob", "[0.1, 0.2, 0.3, 0.4]"), (Distortion{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(distortion("rational_polynomial", "[0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0]"),
            (Distortion{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(distortion("none", "[]"), Distortion{});
  EXPECT_EQ(distortion("rational_polynomial", "[0, 0, 0, 0, 0, 1, 0, 0]"),
            (Distortion{0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_THAT(MessageOf([&] { distortion("rational_polynomial", "[0.1, 0, 0, 0]"); }),
              HasSubstr("'rational_polynomial' is not modelled"));
  EXPECT_THAT(MessageOf([&] { distortion("equidistant", "[0.1, 0, 0, 0]"); }),
              HasSubstr("'equidistant' is not modelled"));
}

TEST(RosCameraInfo, AsksForTheUnitOfDepth) {
  EXPECT_THAT(MessageOf([] { Read(Calibration("plumb_bob", "[]")); }),
              AllOf(HasSubstr("camera.yaml:1:1"), HasSubstr("ROS' camera_info"),
                    HasSubstr("unit_m: 0.001")));
  std::string flat = Calibration("plumb_bob", "[]") + "unit_m: 0.001\n";
  flat.replace(flat.find("610.5"), 5, "0.0");
  EXPECT_THAT(MessageOf([&] { Read(flat); }), HasSubstr("nine numbers"));
}

TEST(CameraFile, DistortionMayHaveAZeroTailOrBeNone) {
  const auto with = [](const std::string& distortion) {
    return Read(
               "depth: {width_px: 4, height_px: 3, fx_px: 2, fy_px: 2, cx_px: 1, cy_px: 1, unit_m: "
               "0.001, distortion: " +
               distortion + "}\n")
        .depth.distortion;
  };
  EXPECT_EQ(with("[0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0]"), (Distortion{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(with("none"), Distortion{});
  EXPECT_EQ(with("[]"), Distortion{});
}

}  // namespace
}  // namespace palpate::rgbd
