// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/convert_driver.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "libs/core/file.hpp"
#include "libs/dds/message.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::perception {
namespace {

using idl::sensor_msgs::CameraInfo;
using idl::sensor_msgs::Image;
using testing::ElementsAre;
using testing::HasSubstr;

/// An image of `values`, each row with `padding` bytes at its end.
template <typename T>
dds::Message<Image> ImageOf(const std::string& encoding, std::uint32_t width,
                            const std::vector<T>& values, std::uint32_t channels = 1,
                            std::uint32_t padding = 0) {
  dds::Message<Image> message;
  dds::SetText(message->encoding, encoding);
  message->width = width;
  message->height = static_cast<std::uint32_t>(values.size()) / (width * channels);
  const std::size_t row_bytes = width * channels * sizeof(T);
  message->step = static_cast<std::uint32_t>(row_bytes) + padding;
  dds::Resize(message->data, std::size_t{message->step} * message->height);
  for (std::size_t v = 0; v < message->height; ++v) {
    std::memcpy(message->data._buffer + v * message->step, values.data() + v * width * channels,
                row_bytes);
  }
  return message;
}

TEST(DriverDepth, SixteenBitsAreTakenAsTheyAre) {
  for (const char* encoding : {"16UC1", "mono16"}) {
    rgbd::DepthImage image;
    double unit_m = 0.0;
    const auto message = ImageOf<std::uint16_t>(encoding, 2, {0, 400, 65535, 1}, 1, 6);
    ASSERT_TRUE(FromDriverDepth(*message, 1e-3, 2.0, &image, &unit_m).ok());
    EXPECT_EQ(unit_m, 1e-3);
    EXPECT_EQ(image.width_px, 2);
    EXPECT_THAT(image.values, ElementsAre(0, 400, 65535, 1));
  }
}

TEST(DriverDepth, MetresAreTakenInTheFinestStepsThatReachTheLargestDepth) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  rgbd::DepthImage image;
  double unit_m = 0.0;
  const auto message =
      ImageOf<float>("32FC1", 4, {0.45f, 2.0f, kNan, kInf, -1.0f, 0.0f, 2.1f, 1.0f});
  ASSERT_TRUE(FromDriverDepth(*message, 1e-3, 2.0, &image, &unit_m).ok());
  EXPECT_DOUBLE_EQ(unit_m, 2.0 / 65535);
  const std::vector<double> expected_m{0.45, 2.0, 0, 0, 0, 0, 0, 1.0};
  for (std::size_t i = 0; i < expected_m.size(); ++i) {
    EXPECT_NEAR(image.values[i] * unit_m, expected_m[i], 0.5 * unit_m + 1e-7) << i;
  }
}

TEST(DriverDepth, OtherEncodingsAndShortDataAreRefused) {
  rgbd::DepthImage image;
  double unit_m = 0.0;
  Status status =
      FromDriverDepth(*ImageOf<std::uint8_t>("rgb8", 1, {1, 2, 3}, 3), 1e-3, 2.0, &image, &unit_m);
  EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(status.message(), HasSubstr("'rgb8' instead of 16UC1 (mm) or 32FC1 (m)"));
  auto big_endian = ImageOf<std::uint16_t>("16UC1", 1, {1});
  big_endian->is_bigendian = 1;
  status = FromDriverDepth(*big_endian, 1e-3, 2.0, &image, &unit_m);
  EXPECT_THAT(status.message(), HasSubstr("big-endian"));
  for (const char* encoding : {"16UC1", "32FC1"}) {
    auto cut = ImageOf<std::uint16_t>(encoding, 2, {1, 2, 3, 4});
    cut->height = 100;
    status = FromDriverDepth(*cut, 1e-3, 2.0, &image, &unit_m);
    EXPECT_THAT(status.message(), HasSubstr("2 x 100 pixels in 8 bytes")) << encoding;
  }
}

TEST(DriverColor, EveryEncodingBecomesRedGreenBlue) {
  const auto rgb = [](const dds::Message<Image>& message) {
    rgbd::ColorImage image;
    EXPECT_TRUE(FromDriverColor(*message, &image).ok());
    return image.values;
  };
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(rgb(ImageOf<std::uint8_t>("rgb8", 2, {1, 2, 3, 4, 5, 6}, 3, 5)),
            (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(rgb(ImageOf<std::uint8_t>("bgr8", 1, {3, 2, 1}, 3)), (Bytes{1, 2, 3}));
  EXPECT_EQ(rgb(ImageOf<std::uint8_t>("rgba8", 1, {1, 2, 3, 9}, 4)), (Bytes{1, 2, 3}));
  EXPECT_EQ(rgb(ImageOf<std::uint8_t>("bgra8", 1, {3, 2, 1, 9}, 4)), (Bytes{1, 2, 3}));
  EXPECT_EQ(rgb(ImageOf<std::uint8_t>("mono8", 1, {7}, 1)), (Bytes{7, 7, 7}));
  rgbd::ColorImage image;
  EXPECT_THAT(FromDriverColor(*ImageOf<std::uint8_t>("yuv422", 1, {1, 2}, 2), &image).message(),
              HasSubstr("'yuv422' instead of rgb8, bgr8"));
}

dds::Message<CameraInfo> InfoOf(const std::string& model, const std::vector<double>& distortion) {
  dds::Message<CameraInfo> info;
  info->width = 640;
  info->height = 480;
  const std::array<double, 9> k{600, 0, 320, 0, 601, 240, 0, 0, 1};
  std::copy(k.begin(), k.end(), info->k);
  const std::array<double, 12> p{590, 0, 310, 0, 0, 591, 230, 0, 0, 0, 1, 0};
  std::copy(p.begin(), p.end(), info->p);
  dds::SetText(info->distortion_model, model);
  dds::SetNumbers(info->d, distortion.data(), distortion.size());
  return info;
}

TEST(DriverInfo, LensesOfPlumbBobAndThoseEqualToIt) {
  rgbd::CameraModel camera;
  ASSERT_TRUE(FromDriverInfo(*InfoOf("plumb_bob", {0.1, 0.2, 0.3, 0.4, 0.5}), false, &camera).ok());
  EXPECT_EQ(camera, (rgbd::CameraModel{640, 480, 600, 601, 320, 240, {0.1, 0.2, 0.3, 0.4, 0.5}}));
  ASSERT_TRUE(FromDriverInfo(*InfoOf("plumb_bob", {0.1, 0.2, 0.3, 0.4}), false, &camera).ok());
  EXPECT_EQ(camera.distortion[4], 0.0);
  const std::vector<double> tail{0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0};
  ASSERT_TRUE(FromDriverInfo(*InfoOf("rational_polynomial", tail), false, &camera).ok());
  EXPECT_EQ(camera.distortion[4], 0.5);
  for (const char* model : {"", "none", "equidistant", "rational_polynomial"}) {
    ASSERT_TRUE(FromDriverInfo(*InfoOf(model, {0, 0, 0, 0}), false, &camera).ok()) << model;
    EXPECT_FALSE(camera.distorted());
  }
}

TEST(DriverInfo, ARectifiedImageHasTheLensOfP) {
  rgbd::CameraModel camera;
  ASSERT_TRUE(FromDriverInfo(*InfoOf("equidistant", {0.1, 0.2, 0.3, 0.4}), true, &camera).ok());
  EXPECT_EQ(camera, (rgbd::CameraModel{640, 480, 590, 591, 310, 230, {}}));
}

TEST(DriverInfo, OtherLensesAreRefusedWithTheRemedy) {
  rgbd::CameraModel camera;
  const auto fisheye = InfoOf("equidistant", {0.1, 0.2, 0.3, 0.4});
  EXPECT_THAT(FromDriverInfo(*fisheye, false, &camera).message(), HasSubstr("image_rect"));
  const auto rational = InfoOf("rational_polynomial", {1, 1, 1, 1, 1, 1, 1});
  EXPECT_EQ(FromDriverInfo(*rational, false, &camera).code(), StatusCode::kInvalidInput);
  const auto nan = InfoOf("plumb_bob", {std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0});
  EXPECT_EQ(FromDriverInfo(*nan, false, &camera).code(), StatusCode::kInvalidInput);
}

/// A message of image_transport: `header` in front of a PNG.
dds::Message<idl::sensor_msgs::CompressedImage> PackedOf(const std::string& format,
                                                         const std::string& data) {
  dds::Message<idl::sensor_msgs::CompressedImage> message;
  dds::SetText(message->format, format);
  dds::Resize(message->data, data.size());
  std::memcpy(message->data._buffer, data.data(), data.size());
  return message;
}

/// Format, and the two parameters of packed metres.
std::string DepthHeader(float a, float b) {
  std::string header(12, '\0');
  std::memcpy(header.data() + 4, &a, sizeof(a));
  std::memcpy(header.data() + 8, &b, sizeof(b));
  return header;
}

std::string DepthPng() {
  const test_support::TestFolder folder;
  rgbd::DepthImage image(2, 2);
  image.values = {1000, 0, 2000, 500};
  rgbd::WriteDepthPng(folder / "depth.png", image);
  return ReadFile(folder / "depth.png");
}

TEST(PackedDepth, StepsAreTakenAsTheyAre) {
  rgbd::DepthImage image;
  double unit_m = 0.0;
  const auto message = PackedOf("16UC1; compressedDepth png", DepthHeader(0, 0) + DepthPng());
  ASSERT_TRUE(FromDriverDepth(*message, 1e-3, 2.0, &image, &unit_m).ok());
  EXPECT_EQ(unit_m, 1e-3);
  EXPECT_THAT(image.values, ElementsAre(1000, 0, 2000, 500));
}

TEST(PackedDepth, MetresAreThoseOfItsHeader) {
  rgbd::DepthImage image;
  double unit_m = 0.0;
  const auto message = PackedOf("32FC1; compressedDepth png", DepthHeader(1000, 0) + DepthPng());
  ASSERT_TRUE(FromDriverDepth(*message, 1e-3, 1.5, &image, &unit_m).ok());
  EXPECT_NEAR(image.values[0] * unit_m, 1.0, unit_m);
  EXPECT_EQ(image.values[1], 0);
  EXPECT_NEAR(image.values[2] * unit_m, 0.5, unit_m);
  EXPECT_EQ(image.values[3], 0) << "2 m are beyond the range";
}

TEST(PackedDepth, WhatCannotBeReadIsNamed) {
  rgbd::DepthImage image;
  double unit_m = 0.0;
  const Status damaged =
      FromDriverDepth(*PackedOf("16UC1; compressedDepth", "short"), 1e-3, 2.0, &image, &unit_m);
  EXPECT_EQ(damaged.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(damaged.message(), HasSubstr("is no whole image"));
  const auto rvl = PackedOf("16UC1; compressedDepth rvl", std::string(20, '\0'));
  EXPECT_THAT(FromDriverDepth(*rvl, 1e-3, 2.0, &image, &unit_m).message(), HasSubstr("RVL"));
}

TEST(PackedColor, APngIsRedGreenBlue) {
  rgbd::ColorImage orange(1, 1);
  orange.values = {200, 120, 40};
  rgbd::ColorImage image;
  const auto message = PackedOf("rgb8; png compressed", rgbd::EncodeColorPng(orange, 1));
  ASSERT_TRUE(FromDriverColor(*message, &image).ok());
  EXPECT_THAT(image.values, ElementsAre(200, 120, 40));
  EXPECT_EQ(FromDriverColor(*PackedOf("jpeg", "no image"), &image).code(),
            StatusCode::kInvalidInput);
}

}  // namespace
}  // namespace palpate::perception
