// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/rgbd_camera.hpp"

#include <array>
#include <regex>
#include <string>
#include <utility>

#include "libs/app/yaml.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::rgbd {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kCamera = R"(depth:
  width_px: 848
  height_px: 480
  fx_px: 425.5
  fy_px: 430.25
  cx_px: 421.75
  cy_px: 238.5
  distortion: [0.1, -0.2, 0.003, -0.004, 0.05]
  unit_m: 0.0001
  invalid_value: 65535
  baseline_m: 0.05
color:
  width_px: 640
  height_px: 400
  fx_px: 610.5
  fy_px: 611
  cx_px: 320
  cy_px: 200.125
  distortion: [0, 0, 0, 0, 0.1]
  registered_to_depth: false
  T_depth_color: {translation_m: [0.015, -0.001, 0.002], rotation_xyzw: {x: 0.6, y: 0, z: 0, w: 0.8}}
)";

/// kCamera with one piece replaced.
std::string With(const std::string& old, const std::string& fresh) {
  std::string text = kCamera;
  const std::size_t place = text.find(old);
  EXPECT_NE(place, std::string::npos) << old;
  return text.replace(place, old.size(), fresh);
}

RgbdCamera Parse(const std::string& text) { return ReadCamera(app::ParseYaml(text, "c.yaml")); }

std::string RefusalOf(const std::string& text) {
  return MessageOf([&] { Parse(text); });
}

std::string RefusalWith(const std::string& old, const std::string& fresh) {
  return RefusalOf(With(old, fresh));
}

TEST(RgbdCamera, ReadsEveryKey) {
  const RgbdCamera camera = Parse(kCamera);
  const CameraModel depth{848, 480, 425.5, 430.25, 421.75, 238.5, {0.1, -0.2, 0.003, -0.004, 0.05}};
  const CameraModel color{640, 400, 610.5, 611, 320, 200.125, {0, 0, 0, 0, 0.1}};
  EXPECT_EQ(camera.depth, depth);
  EXPECT_EQ(camera.color, color);
  EXPECT_EQ(camera.depth_unit_m, 1e-4);
  EXPECT_EQ(camera.invalid_value, 65535);
  EXPECT_EQ(camera.baseline_m, 0.05);
  EXPECT_FALSE(camera.color_registered);
  EXPECT_EQ(camera.T_depth_color.translation(), Eigen::Vector3d(0.015, -0.001, 0.002));
  EXPECT_NEAR(camera.T_depth_color.linear()(1, 2), -0.96, 1e-15);  // -sin of 2 acos 0.8
}

TEST(RgbdCamera, DistortionMayEndBeforeItsLastNumberOrBeNone) {
  const std::string five = "distortion: [0.1, -0.2, 0.003, -0.004, 0.05]";
  const Distortion without_k3{0.1, -0.2, 0.003, -0.004};
  EXPECT_EQ(Parse(With(five, "distortion: [0.1, -0.2, 0.003, -0.004]")).depth.distortion,
            without_k3);
  EXPECT_FALSE(Parse(With(five, "distortion: []")).depth.distorted());
  const RgbdCamera rational = Parse(With(five, "distortion: [1, 2, 0, 0, 3, 4, 5, 6]"));
  EXPECT_TRUE(rational.depth.rational());
  EXPECT_EQ(Parse(FormatCameraFile(rational)).depth, rational.depth);
}

TEST(RgbdCamera, OneCameraIsAnotherWhereAnyOfItsNumbersIs) {
  const RgbdCamera camera = Parse(kCamera);
  EXPECT_EQ(camera, Parse(kCamera));
  for (const auto& [old, fresh] :
       {std::pair("unit_m: 0.0001", "unit_m: 0.0002"), std::pair("65535", "0"),
        std::pair("baseline_m: 0.05", "baseline_m: 0.06"), std::pair("fx_px: 610.5", "fx_px: 610"),
        std::pair("[0.015, -0.001", "[0.016, -0.001"), std::pair("fx_px: 425.5", "fx_px: 425")}) {
    EXPECT_FALSE(camera == Parse(With(old, fresh))) << old;
  }
}

TEST(RgbdCamera, ReadsBackFromTheFileWhatItWrites) {
  const TestFolder folder;
  RgbdCamera camera = Parse(kCamera);
  camera.depth.fx_px = 425.0 + 1.0 / 3.0;
  const RgbdCamera again =
      ReadCameraFile(folder.Write("camera.yaml", FormatCameraFile(camera)), app::LoadYaml);
  EXPECT_EQ(again.depth, camera.depth);
  EXPECT_EQ(again.color, camera.color);
  EXPECT_EQ(again.depth_unit_m, camera.depth_unit_m);
  EXPECT_EQ(again.invalid_value, camera.invalid_value);
  EXPECT_EQ(again.baseline_m, camera.baseline_m);
  EXPECT_EQ(again.color_registered, camera.color_registered);
  EXPECT_TRUE(again.T_depth_color.matrix().isApprox(camera.T_depth_color.matrix(), 1e-15));
}

TEST(RgbdCamera, WritesARegisteredCameraAndOneWithoutColour) {
  RgbdCamera camera = Parse(kCamera);
  camera.color = camera.depth;
  camera.color_registered = true;
  EXPECT_TRUE(Parse(FormatCameraFile(camera)).color_registered);
  camera.color.width_px = 0;
  const RgbdCamera again = Parse(FormatCameraFile(camera));
  EXPECT_EQ(again.color.width_px, 0);
  EXPECT_EQ(again.depth, camera.depth);
}

TEST(RgbdCamera, DoesWithoutWhatMayBeMissing) {
  const RgbdCamera camera = Parse(
      "depth: {width_px: 8, height_px: 4, fx_px: 5, fy_px: 5, cx_px: 4, cy_px: 2, unit_m: 0.001}\n"
      "color: {width_px: 8, height_px: 4, fx_px: 5, fy_px: 5, cx_px: 4, cy_px: 2, "
      "registered_to_depth: true}\n");
  EXPECT_FALSE(camera.depth.distorted());
  EXPECT_EQ(camera.invalid_value, 0);
  EXPECT_EQ(camera.baseline_m, 0.0);
  EXPECT_TRUE(camera.T_depth_color.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(RgbdCamera, RefusesAMissingKeyWithItsPlace) {
  for (const std::string key :
       {"width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px", "unit_m"}) {
    const std::string text =
        std::regex_replace(std::string(kCamera), std::regex("  " + key + ": [^\n]*\n"), "",
                           std::regex_constants::format_first_only);
    EXPECT_THAT(RefusalOf(text), AllOf(HasSubstr("c.yaml:2:"), HasSubstr("'" + key + "'"))) << key;
  }
  EXPECT_THAT(RefusalOf("color: {}\n"), HasSubstr("key 'depth' is missing"));
}

TEST(RgbdCamera, RefusesKeysThatItDoesNotKnow) {
  EXPECT_THAT(RefusalWith("fx_px: 425.5", "fx: 425.5"), HasSubstr("key 'fx_px' is missing"));
  EXPECT_THAT(RefusalWith("  baseline_m", "  basline_m"),
              AllOf(HasSubstr("c.yaml:11:3"), HasSubstr("did you mean 'baseline_m'")));
  EXPECT_THAT(RefusalWith("  registered_to_depth", "  registered"),
              AllOf(HasSubstr("c.yaml:20:3"), HasSubstr("unknown key 'color.registered'")));
  EXPECT_THAT(RefusalOf(std::string(kCamera) + "colour: {}\n"), HasSubstr("did you mean 'color'"));
}

TEST(RgbdCamera, RefusesValuesThatNoCameraHas) {
  EXPECT_THAT(RefusalWith("width_px: 848", "width_px: 0"),
              AllOf(HasSubstr("c.yaml:2:13"), HasSubstr("must be 1 to 16384, not 0")));
  EXPECT_THAT(RefusalWith("height_px: 480", "height_px: 480.5"), HasSubstr("whole number"));
  EXPECT_THAT(RefusalWith("fx_px: 425.5", "fx_px: 0"), HasSubstr("must be > 0, not 0"));
  EXPECT_THAT(RefusalWith("fy_px: 430.25", "fy_px: -1"), HasSubstr("must be > 0, not -1"));
  EXPECT_THAT(RefusalWith("cx_px: 421.75", "cx_px: .nan"), HasSubstr("must be finite"));
  EXPECT_THAT(RefusalWith("unit_m: 0.0001", "unit_m: 1"), HasSubstr("> 0 and <= 0.1"));
  EXPECT_THAT(RefusalWith("unit_m: 0.0001", "unit_m: 0"), HasSubstr("> 0 and <= 0.1"));
  EXPECT_THAT(RefusalWith("invalid_value: 65535", "invalid_value: 65536"), HasSubstr("0 to 65535"));
  EXPECT_THAT(RefusalWith("baseline_m: 0.05", "baseline_m: 50"), HasSubstr("<= 2"));
  EXPECT_THAT(RefusalWith("baseline_m: 0.05", "baseline_m: -0.05"), HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("[0.1, -0.2, 0.003, -0.004, 0.05]", "[0.1, -0.2]"),
              AllOf(HasSubstr("c.yaml:8:15"), HasSubstr("[k1, k2, p1, p2, k3]"),
                    HasSubstr("not a list of 2")));
  EXPECT_THAT(
      RefusalWith("[0.1, -0.2, 0.003, -0.004, 0.05]", "[0.1, -0.2, 0.003, -0.004, 0.05, 1]"),
      HasSubstr("not a list of 6"));
  EXPECT_THAT(RefusalWith("w: 0.8", "w: 0.9"), HasSubstr("norm 1"));
}

TEST(RgbdCamera, RefusesAColourCameraOfUnknownPlace) {
  const std::string text =
      std::regex_replace(std::string(kCamera), std::regex("  T_depth_color[^\n]*\n"), "");
  EXPECT_THAT(RefusalOf(text), HasSubstr("'T_depth_color' is missing"));
}

TEST(RgbdCamera, RefusesARegisteredImageThatIsNotTheDepthImages) {
  EXPECT_THAT(RefusalWith("registered_to_depth: false", "registered_to_depth: true"),
              HasSubstr("has the size, focal length, centre and distortion of 'depth'"));
}

TEST(RgbdCamera, LeavesTheOtherKeysOfAMapToTheirReader) {
  const ConfigNode node = app::ParseYaml(std::string(kCamera) + "rate_hz: 15\n", "c.yaml");
  MapReader reader(node);
  EXPECT_EQ(ReadCamera(reader).depth.width_px, 848);
  EXPECT_THAT(MessageOf([&] { reader.Finish(); }), HasSubstr("unknown key 'rate_hz'"));
  EXPECT_EQ(reader.Number("rate_hz", 0.0), 15.0);
  EXPECT_NO_THROW(reader.Finish());
}

}  // namespace
}  // namespace palpate::rgbd
