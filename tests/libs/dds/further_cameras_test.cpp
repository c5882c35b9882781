// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/further_cameras.hpp"

#include <gmock/gmock.h>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/camera_topics.hpp"

namespace palpate::dds {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string Refusal(const std::vector<std::string>& items) {
  try {
    ReadFurtherCameras(items, app::ParseYaml);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FurtherCameras, AreReadWithAndWithoutPoseInTheOrderOfTheirNames) {
  const auto cameras = ReadFurtherCameras(
      {"top", "back: {translation_m: [1, 2, 3], rotation_xyzw: [0, 0, 1, 0]}"}, app::ParseYaml);
  EXPECT_THAT(NamesOf(cameras), ElementsAre("back", "top"));
  ASSERT_TRUE(cameras[0].T_robot_camera);
  EXPECT_EQ(cameras[0].T_robot_camera->translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(cameras[1].T_robot_camera);
  EXPECT_TRUE(ReadFurtherCameras({}, app::ParseYaml).empty());
}

TEST(FurtherCameras, RefusesWhatIsNoCamera) {
  EXPECT_EQ(Refusal({"back"}), "accepted");
  EXPECT_THAT(Refusal({"back", "back"}), HasSubstr("given twice"));
  EXPECT_THAT(Refusal({"2nd"}), HasSubstr("no name of a camera"));
  EXPECT_THAT(Refusal({"_back"}), HasSubstr("no name of a camera"));
  EXPECT_THAT(Refusal({"back/left"}), HasSubstr("no name of a camera"));
  EXPECT_THAT(Refusal({"''"}), HasSubstr("without a name"));
  EXPECT_THAT(Refusal({"back: {translation_m: [1, 2, 3]}"}), HasSubstr("rotation_xyzw"));
  EXPECT_THAT(Refusal({"back: {translation_m: [1, 2, 3], rotation_xyzw: [0, 0, 1, 1]}"}),
              HasSubstr("rotation_xyzw"));
}

TEST(FurtherCameras, TakePosesOfACalibrationWhereTheSettingsGiveNone) {
  const auto at = [](double x_m) { return Eigen::Isometry3d(Eigen::Translation3d(x_m, 0.0, 0.0)); };
  const std::vector<FurtherCamera> calibrated{{"back", at(1.0)}, {"top", at(2.0)}};
  std::vector<FurtherCamera> cameras{{"back", std::nullopt}, {"top", at(3.0)}};
  EXPECT_EQ(TakePoses(calibrated, "c.yaml", &cameras), "");
  EXPECT_EQ(cameras[0].T_robot_camera->translation().x(), 1.0);
  EXPECT_EQ(cameras[1].T_robot_camera->translation().x(), 3.0) << "that of the settings";
  cameras = {{"back", std::nullopt}};
  EXPECT_EQ(TakePoses(calibrated, "c.yaml", &cameras),
            "c.yaml: it has camera 'top', not in the setting 'cameras'");
  cameras = {{"bak", std::nullopt}};
  try {
    TakePoses(calibrated, "c.yaml", &cameras);
    ADD_FAILURE() << "'bak' was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cameras: 'bak' is not in c.yaml (did you mean 'back'?); calibrate it, or write "
                 "its pose behind its name");
  }
}

TEST(FurtherCameras, AreMatchedWithThoseOfACalibration) {
  const CameraMatch both = MatchCameras({"back", "top"}, {"back", "left"});
  EXPECT_THAT(both.missing, ElementsAre("top"));
  EXPECT_THAT(both.unknown, ElementsAre("left"));
  EXPECT_EQ(Describe(both),
            "it has no pose of camera 'top': its poses and depth biases do not count, calibrate "
            "all cameras together; it has camera 'left', not in the setting 'cameras'");
  EXPECT_EQ(Describe(MatchCameras({"back", "top"}, {"top", "back"})), "");
  EXPECT_EQ(Describe(MatchCameras({}, {"back", "top"})),
            "it has cameras 'back', 'top', not in the setting 'cameras'");
}

TEST(CameraTopics, AreThoseOfTheFirstWithoutANameAndOfTheNamedOneWithIt) {
  const CameraTopics first = TopicsOf("");
  EXPECT_EQ(first.depth.name, "/camera/depth/image_raw");
  EXPECT_EQ(first.depth_frame, "camera_depth_optical_frame");
  const CameraTopics back = TopicsOf("back");
  EXPECT_EQ(back.prefix, "/camera_back");
  EXPECT_EQ(back.depth.name, "/camera_<name>/depth/image_raw");
  EXPECT_EQ(back.depth_frame, "camera_back_depth_optical_frame");
  EXPECT_EQ(back.color_frame, "camera_back_color_optical_frame");
}

}  // namespace
}  // namespace palpate::dds
