// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/rgbd/color_image.hpp"
#include "libs/rgbd/jpeg.hpp"
#include "libs/rgbd/png.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "tests/support/memory_limit.hpp"
#include "tests/support/mutations.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::rgbd {
namespace {

constexpr const char* kCameraInfo =
    "image_width: 640\nimage_height: 480\ncamera_name: depth\ncamera_matrix:\n  rows: 3\n"
    "  cols: 3\n  data: [610.5, 0.0, 320.25, 0.0, 612.0, 239.5, 0.0, 0.0, 1.0]\n"
    "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
    "  data: [0.1, -0.2, 0.001, 0.002, 0.05]\nunit_m: 0.001\n";

ColorImage Gradient() {
  ColorImage image(24, 16);
  for (std::size_t k = 0; k < image.values.size(); ++k) {
    image.values[k] = static_cast<std::uint8_t>(5 * k);
  }
  return image;
}

struct ImageFile {
  std::string name;
  std::string bytes;
};

std::vector<ImageFile> ValidImages(const test_support::TestFolder& folder) {
  DepthImage depth(24, 16, 500);
  depth.values[7] = 1234;
  WriteDepthPng(folder / "valid_depth.png", depth);
  WriteColorPng(folder / "valid_color.png", Gradient());
  return {{"depth.png", ReadFile(folder / "valid_depth.png")},
          {"color.png", ReadFile(folder / "valid_color.png")},
          {"color.jpg", EncodeJpeg(Gradient(), 90)},
          {"camera.yaml", kCameraInfo}};
}

void ReadImage(const std::filesystem::path& file) {
  if (file.extension() == ".yaml") {
    ReadCameraFile(file, app::LoadYaml);
  } else if (file.stem() == "depth") {
    ReadDepthPng(file);
  } else {
    ReadColorImage(file);
  }
}

void ReadOrRefuseImages(int rounds, unsigned seed) {
  const test_support::TestFolder folder;
  const test_support::MemoryLimit limit(test_support::kReaderLimit_bytes);
  test_support::Mutations mutations(seed);
  int refused = 0, read = 0;
  for (const ImageFile& file : ValidImages(folder)) {
    EXPECT_NO_THROW(ReadImage(folder.Write(file.name, file.bytes))) << file.name;
    for (int round = 0; round < rounds; ++round) {
      try {
        ReadImage(folder.Write(file.name, mutations.Of(file.bytes)));
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, rounds);
  EXPECT_GT(read, rounds / 10);
}

TEST(MutatedImages, AreReadOrRefused) { ReadOrRefuseImages(200, 20261128); }

TEST(MutatedImages, AreReadOrRefusedInManyRounds) { ReadOrRefuseImages(20000, 7); }

}  // namespace
}  // namespace palpate::rgbd
