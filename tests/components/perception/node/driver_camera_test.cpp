// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/driver_camera.hpp"

#include <gmock/gmock.h>

#include <optional>
#include <string>

#include "libs/dds/geometry_messages.hpp"
#include "tests/components/perception/node/driver_fixture.hpp"

namespace palpate::perception {
namespace {

using testing::HasSubstr;

const Eigen::Isometry3d kBeside(Eigen::Translation3d(0.015, 0.0, 0.0));

/// Both streams with their lenses, colour in `color_frame`.
DriverCamera CameraWith(const std::string& color_frame, double color_fx_px,
                        std::optional<Eigen::Isometry3d> given = std::nullopt) {
  DriverCamera camera(given, 0.05);
  camera.depth().image_topic = "/d/image_rect_raw";
  camera.depth().info_topic = "/d/camera_info";
  camera.color().image_topic = "/c/image_raw";
  camera.color().info_topic = "/c/camera_info";
  camera.depth().frame = "depth_frame";
  camera.color().frame = color_frame;
  camera.depth().SetInfo(*DriverInfo(5.0, 0, "depth_frame"));
  camera.color().SetInfo(*DriverInfo(color_fx_px, 0, color_frame));
  return camera;
}

dds::Message<idl::tf2_msgs::TFMessage> TransformOf(const std::string& parent,
                                                   const std::string& child,
                                                   const Eigen::Isometry3d& T_parent_child) {
  dds::Message<idl::tf2_msgs::TFMessage> message;
  dds::Resize(message->transforms, 1);
  auto& transform = message->transforms._buffer[0];
  dds::SetHeader(transform.header, 0, parent);
  dds::SetText(transform.child_frame_id, child);
  dds::SetVector(transform.transform.translation, T_parent_child.translation());
  transform.transform.rotation.w = 1.0;
  return message;
}

TEST(DriverCamera, ColourOfTheSameFrameSizeAndLensIsRegistered) {
  rgbd::RgbdCamera camera;
  ASSERT_TRUE(CameraWith("depth_frame", 5.0).CameraOf(true, 1e-3, &camera).ok());
  EXPECT_TRUE(camera.color_registered);
  EXPECT_EQ(camera.depth_unit_m, 1e-3);
  EXPECT_EQ(camera.baseline_m, 0.05);
  EXPECT_EQ(camera.depth.fx_px, 5.0);
}

TEST(DriverCamera, ColourOfTheSameFrameButAnotherLensIsNotRegistered) {
  rgbd::RgbdCamera camera;
  ASSERT_TRUE(CameraWith("depth_frame", 6.0).CameraOf(true, 1e-3, &camera).ok());
  EXPECT_FALSE(camera.color_registered);
  EXPECT_EQ(camera.color.fx_px, 6.0);
  EXPECT_TRUE(camera.T_depth_color.matrix().isIdentity());
}

TEST(DriverCamera, ColourOfAnotherFrameStandsWhereTfStaticSays) {
  DriverCamera driver = CameraWith("color_frame", 6.0);
  ASSERT_TRUE(driver.AddTransforms(*TransformOf("camera_link", "depth_frame", kBeside)).ok());
  ASSERT_TRUE(
      driver.AddTransforms(*TransformOf("camera_link", "color_frame", kBeside * kBeside)).ok());
  rgbd::RgbdCamera camera;
  ASSERT_TRUE(driver.CameraOf(true, 1e-3, &camera).ok());
  EXPECT_FALSE(camera.color_registered);
  EXPECT_TRUE(camera.T_depth_color.isApprox(kBeside, 1e-12));
}

TEST(DriverCamera, ThePoseOfTheSettingsWins) {
  rgbd::RgbdCamera camera;
  ASSERT_TRUE(CameraWith("depth_frame", 5.0, kBeside).CameraOf(true, 1e-3, &camera).ok());
  EXPECT_FALSE(camera.color_registered);
  EXPECT_TRUE(camera.T_depth_color.isApprox(kBeside));
}

TEST(DriverCamera, WithoutATransformItSaysHowToMendIt) {
  rgbd::RgbdCamera camera;
  const Status status = CameraWith("color_frame", 6.0).CameraOf(true, 1e-3, &camera);
  EXPECT_EQ(status.code(), StatusCode::kNoCalibration);
  EXPECT_THAT(status.message(), HasSubstr("colour is in frame 'color_frame', depth in "
                                          "'depth_frame'"));
  EXPECT_THAT(status.message(), HasSubstr("camera.T_depth_color"));
  EXPECT_TRUE(CameraWith("color_frame", 6.0).CameraOf(false, 1e-3, &camera).ok());
  EXPECT_EQ(camera.color.width_px, 0);
}

TEST(DriverCamera, WithoutIntrinsicsItSaysWhichTopicLacksThem) {
  rgbd::RgbdCamera camera;
  DriverCamera driver = CameraWith("depth_frame", 0.0);
  Status status = driver.CameraOf(true, 1e-3, &camera);
  EXPECT_EQ(status.code(), StatusCode::kNoCalibration);
  EXPECT_THAT(status.message(), HasSubstr("/c/camera_info has no intrinsics (K is zero)"));
  driver.depth().lens.reset();
  status = driver.CameraOf(false, 1e-3, &camera);
  EXPECT_EQ(status.code(), StatusCode::kNoCalibration);
  EXPECT_THAT(status.message(),
              HasSubstr("no /d/camera_info has come, so /d/image_rect_raw has no intrinsics"));
}

TEST(DriverCamera, ALensThatCannotBeUsedIsRefusedWithItsTopic) {
  DriverCamera driver = CameraWith("depth_frame", 5.0);
  auto fisheye = DriverInfo(5.0, 0, "depth_frame");
  dds::SetText(fisheye->distortion_model, "equidistant");
  fisheye->d._buffer[0] = 0.1;
  driver.color().SetInfo(*fisheye);
  rgbd::RgbdCamera camera;
  const Status status = driver.CameraOf(true, 1e-3, &camera);
  EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(status.message(), HasSubstr("/c/camera_info: distortion model 'equidistant'"));
}

TEST(DriverCamera, RectifiedImagesAreKnownByTheirNames) {
  DriverStream stream;
  for (const char* rectified : {"/a/image_rect", "/a/image_rect_raw", "/a/b/image_rect_color",
                                "/a/image_rect/compressed", "/a/image_rect_raw/compressedDepth"}) {
    stream.image_topic = rectified;
    EXPECT_TRUE(stream.is_rectified()) << rectified;
  }
  for (const char* raw :
       {"/a/image_raw", "/image_rect/image_raw", "/image", "/image_rect/image_raw/compressed"}) {
    stream.image_topic = raw;
    EXPECT_FALSE(stream.is_rectified()) << raw;
  }
}

}  // namespace
}  // namespace palpate::perception
