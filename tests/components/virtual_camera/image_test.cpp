// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Images to judge by eye, in the build folder: pictures/virtual_camera_*.png.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "libs/rgbd/png.hpp"
#include "tests/components/virtual_camera/bench.hpp"

namespace palpate::virtual_camera {
namespace {

// Near is bright: 0.25 m white, 1.25 m black; holes are blue.
rgbd::ColorImage PictureOf(const rgbd::DepthImage& depth, double unit_m) {
  rgbd::ColorImage image(depth.width_px, depth.height_px);
  for (int v = 0; v < depth.height_px; ++v) {
    for (int u = 0; u < depth.width_px; ++u) {
      const int raw = *depth.Pixel(u, v);
      const double share = std::clamp(1.25 - raw * unit_m, 0.0, 1.0);
      const auto grey = static_cast<std::uint8_t>(255.0 * share);
      std::uint8_t* pixel = image.Pixel(u, v);
      pixel[0] = raw == 0 ? 20 : grey;
      pixel[1] = raw == 0 ? 40 : grey;
      pixel[2] = raw == 0 ? 160 : grey;
    }
  }
  return image;
}

void Draw(const std::string& name, const scenario::Scenario& scenario, const View& view) {
  VirtualCamera camera(scenario, FourLegSurface(), {}, 1);
  rgbd::RgbdFrame frame;
  camera.Take(view, &frame);
  const std::filesystem::path folder = PALPATE_BINARY_DIR "/pictures";
  std::filesystem::create_directories(folder);
  rgbd::WriteColorPng(folder / ("virtual_camera_" + name + "_color.png"), frame.color);
  rgbd::WriteColorPng(folder / ("virtual_camera_" + name + "_depth.png"),
                      PictureOf(frame.depth, scenario.camera->camera.depth_unit_m));
  const auto colored = [&frame](int red, int green, int blue) {
    int count = 0;
    for (std::size_t i = 0; i < frame.color.values.size(); i += 3) {
      count += std::abs(frame.color.values[i] - red) + std::abs(frame.color.values[i + 1] - green) +
                           std::abs(frame.color.values[i + 2] - blue) <
                       60
                   ? 1
                   : 0;
    }
    return count;
  };
  EXPECT_GT(colored(190, 67, 56), 5000) << "of the robot's colour";
  EXPECT_GT(colored(110, 80, 54), 40000) << "of the table's";
  EXPECT_GT(colored(150, 150, 155), 10000) << "of the wall's";
}

TEST(Picture, RobotAtRest) {
  const scenario::Scenario scenario = NoisyScenario();
  Draw("rest", scenario, RestingView(scenario));
}

TEST(Picture, RobotAmongTools) {
  const scenario::Scenario scenario = NoisyScenario();
  Draw("tools", scenario, CrowdedView(scenario));
}

}  // namespace
}  // namespace palpate::virtual_camera
