// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Both segmentations and the contacts on real Kinect clouds, where a thing of one colour is taken
// for the robot. With PALPATE_PICTURES=folder the results are drawn there: robot red, objects
// green, contacts as yellow crosses.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "components/perception/perception.hpp"
#include "libs/experiment/cloud/point_cloud.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::perception {
namespace {

namespace fs = std::filesystem;

struct RealCloud {
  std::string name;
  bool turned = false;  ///< y up, z backwards
  bool colored = true;
  std::vector<double> robot_color_rgb;  ///< of what plays the robot; empty: learnt
  Eigen::Array2i from_px;               ///< a rectangle of the image that lies on it
  Eigen::Array2i to_px;
  int fewest_robot_points = 0;
  int fewest_object_points = 0;
};

void PrintTo(const RealCloud& cloud, std::ostream* out) { *out << cloud.name; }

fs::path CloudFolder() { return test_support::MeasuredDataFolder() / "rgbd_clouds"; }

/// The Kinect's, as the points of these files have it: u = 525 x / z + 319.5.
rgbd::RgbdCamera Kinect() {
  rgbd::RgbdCamera camera = experiment::TumCamera();
  camera.depth_unit_m = 1e-3;
  camera.baseline_m = 0.075;
  return camera;
}

rgbd::RgbdFrame ReadFrame(const RealCloud& real) {
  experiment::PointCloud cloud = experiment::ReadPointCloud(CloudFolder() / (real.name + ".pcd"));
  if (real.turned) cloud.points_m.bottomRows<2>() *= -1.0;
  return experiment::FrameFromCloud(cloud, Kinect());
}

/// What the rectangle shows, as triangles: a prediction of that part of the surface.
PredictedSurface SurfaceIn(const RealCloud& real, const rgbd::RgbdFrame& frame) {
  constexpr int kStep_px = 4;
  const rgbd::RgbdCamera camera = Kinect();
  const Eigen::Array2i count = (real.to_px - real.from_px) / kStep_px;
  PredictedSurface surface;
  surface.vertices_m.resize(3, count.prod());
  surface.triangles.resize(3, 2 * (count - 1).prod());
  Eigen::Index next = 0;
  for (int j = 0; j < count.y(); ++j) {
    for (int i = 0; i < count.x(); ++i) {
      const Eigen::Array2i pixel = real.from_px + kStep_px * Eigen::Array2i(i, j);
      const int raw = *frame.depth.Pixel(pixel.x(), pixel.y());
      const int here = j * count.x() + i;
      surface.vertices_m.col(here) =
          raw * camera.depth_unit_m * rgbd::Unproject(camera.depth, pixel.cast<double>().matrix());
      if (i == 0 || j == 0) continue;
      const int above = here - count.x();
      surface.triangles.col(next++) = Eigen::Vector3i(here, above, above - 1);
      surface.triangles.col(next++) = Eigen::Vector3i(here, above - 1, here - 1);
    }
  }
  return surface;
}

void Mark(const rgbd::SensedCloud& cloud, int channel, rgbd::ColorImage* picture) {
  for (Eigen::Index i = 0; i < cloud.Count(); ++i) {
    const Eigen::Vector2d at =
        rgbd::Project(Kinect().depth, cloud.points_m.col(i).cast<double>()).array().round();
    for (int v = static_cast<int>(at.y()) - 1; v <= static_cast<int>(at.y()) + 1; ++v) {
      for (int u = static_cast<int>(at.x()) - 1; u <= static_cast<int>(at.x()) + 1; ++u) {
        if (u < 0 || v < 0 || u >= 640 || v >= 480) continue;
        std::uint8_t* rgb = picture->Pixel(u, v);
        for (int k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>(rgb[k] / 2);
        rgb[channel] = 230;
      }
    }
  }
}

void Draw(const std::string& name, const rgbd::RgbdFrame& frame, const Observation& seen) {
  const char* folder = std::getenv("PALPATE_PICTURES");
  if (folder == nullptr || frame.color.empty()) return;
  rgbd::ColorImage picture = frame.color;
  for (std::size_t i = 0; i < picture.values.size(); i += 3) {
    const int grey = (picture.values[i] + picture.values[i + 1] + picture.values[i + 2]) / 3;
    for (std::size_t k = i; k < i + 3; ++k) picture.values[k] = static_cast<std::uint8_t>(grey);
  }
  Mark(seen.frame.robot, 0, &picture);
  Mark(seen.frame.object, 1, &picture);
  for (const DetectedContact& contact : seen.contacts) {
    const Eigen::Vector2d at = rgbd::Project(Kinect().depth, contact.position_m).array().round();
    for (int off = -8; off <= 8; ++off) {
      for (const auto& [u, v] : {std::pair(off, 0), std::pair(0, off)}) {
        const int x = std::clamp(static_cast<int>(at.x()) + u, 0, 639);
        const int y = std::clamp(static_cast<int>(at.y()) + v, 0, 479);
        std::fill_n(picture.Pixel(x, y), 2, std::uint8_t{255});
        picture.Pixel(x, y)[2] = 0;
      }
    }
  }
  rgbd::WriteColorPng(fs::path(folder) / (name + ".png"), picture);
}

class RealClouds : public testing::TestWithParam<RealCloud> {
 protected:
  void SetUp() override {
    if (!fs::exists(CloudFolder() / (GetParam().name + ".pcd"))) {
      GTEST_SKIP() << "no " << CloudFolder() << " (set PALPATE_DATA_DIR)";
    }
  }

  Observation Look(const std::string& segmentation, const rgbd::RgbdFrame& frame,
                   const PredictedSurface* predicted) {
    Config config;
    config.segmentation = segmentation;
    config.max_z_m = 4.0;
    config.robot_color_rgb = GetParam().robot_color_rgb;
    config.tracking.appear_frames = 1;
    Perception perception(config);
    perception.SetCamera(Kinect());
    Observation seen = perception.Update(frame, predicted);
    Draw(GetParam().name + "_" + segmentation, frame, seen);
    std::cout << segmentation << ": " << seen.frame.status.message() << " robot "
              << seen.frame.robot.Count() << ", objects " << seen.frame.object.Count()
              << ", contacts " << seen.contacts.size() << "\n";
    return seen;
  }
};

TEST_P(RealClouds, AreSegmentedAndTouched) {
  const RealCloud& real = GetParam();
  const rgbd::RgbdFrame frame = ReadFrame(real);
  const PredictedSurface predicted = SurfaceIn(real, frame);
  if (!real.colored) {
    for (const char* segmentation : {"color", "model"}) {
      EXPECT_FALSE(Look(segmentation, frame, &predicted).frame.status.ok());
    }
    return;
  }
  const bool learn = real.robot_color_rgb.empty();
  const Observation by_color = Look("color", frame, learn ? &predicted : nullptr);
  const Observation by_model = Look("model", frame, &predicted);
  for (const Observation* seen : {&by_color, &by_model}) {
    ASSERT_TRUE(seen->frame.status.ok()) << seen->frame.status.message();
    EXPECT_GT(seen->frame.robot.Count(), real.fewest_robot_points);
    EXPECT_GT(seen->frame.object.Count(), real.fewest_object_points);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinect, RealClouds,
                         testing::Values(RealCloud{.name = "milk_cartoon_all_small_clorox",
                                                   .turned = true,
                                                   .robot_color_rgb = {0.05, 0.15, 0.5},
                                                   .from_px = {110, 185},
                                                   .to_px = {150, 285},
                                                   .fewest_robot_points = 300,
                                                   .fewest_object_points = 100},
                                         RealCloud{.name = "test31",
                                                   .robot_color_rgb = {},
                                                   .from_px = {318, 200},
                                                   .to_px = {372, 340},
                                                   .fewest_robot_points = 300,
                                                   .fewest_object_points = 100},
                                         RealCloud{.name = "capture0001",
                                                   .colored = false,
                                                   .robot_color_rgb = {},
                                                   .from_px = {310, 300},
                                                   .to_px = {420, 420}}),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace palpate::perception
