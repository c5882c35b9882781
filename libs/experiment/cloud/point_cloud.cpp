// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/point_cloud.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "libs/core/error.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/cloud/ply.hpp"

namespace palpate::experiment {

namespace {

/// Draws points into an image, nearest first.
class Painter {
 public:
  Painter(const PointCloud& cloud, const rgbd::RgbdCamera& camera)
      : cloud_(cloud), camera_(camera) {
    const int width = camera.depth.width_px;
    const int height = camera.depth.height_px;
    const auto invalid = static_cast<std::uint16_t>(camera.invalid_value);
    frame_.depth = rgbd::DepthImage(width, height, invalid);
    if (camera.color_registered && !cloud.colors_rgb.empty()) {
      frame_.color = rgbd::ColorImage(width, height);
    }
    nearest_m_ = rgbd::RangeImage(width, height, std::numeric_limits<float>::infinity());
  }

  void Paint(Eigen::Index point, int u, int v) {
    const double z_m = cloud_.points_m(2, point);
    const double steps = std::round(z_m / camera_.depth_unit_m);
    const bool can_be_told = steps >= 0.0 && steps <= std::numeric_limits<std::uint16_t>::max() &&
                             steps != camera_.invalid_value;
    if (!(z_m > 0.0) || !can_be_told || z_m >= static_cast<double>(*nearest_m_.Pixel(u, v))) {
      return;
    }
    *nearest_m_.Pixel(u, v) = static_cast<float>(z_m);
    *frame_.depth.Pixel(u, v) = static_cast<std::uint16_t>(steps);
    if (frame_.color.empty()) return;
    const std::uint8_t* color = cloud_.colors_rgb.data() + 3 * point;
    std::copy(color, color + 3, frame_.color.Pixel(u, v));
  }

  rgbd::RgbdFrame TakeFrame() { return std::move(frame_); }

 private:
  const PointCloud& cloud_;
  const rgbd::RgbdCamera& camera_;
  rgbd::RgbdFrame frame_;
  rgbd::RangeImage nearest_m_;
};

}  // namespace

PointCloud ReadPointCloud(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".pcd" || ending == ".PCD") return ReadPcd(file);
  if (ending == ".ply" || ending == ".PLY") return ReadPly(file);
  throw InputError(SourceLocation{file.string()}, "is no point cloud (.pcd, .ply)");
}

rgbd::RgbdFrame FrameFromCloud(const PointCloud& cloud, const rgbd::RgbdCamera& camera) {
  const rgbd::CameraModel& model = camera.depth;
  const bool by_pixel =
      cloud.organised() && cloud.width == model.width_px && cloud.height == model.height_px;
  Painter painter(cloud, camera);
  for (Eigen::Index i = 0; i < cloud.points_m.cols(); ++i) {
    const Eigen::Vector3d point_m = cloud.points_m.col(i);
    if (!(point_m.z() > 0.0)) continue;
    if (by_pixel) {
      painter.Paint(i, static_cast<int>(i % cloud.width), static_cast<int>(i / cloud.width));
      continue;
    }
    const Eigen::Vector2d pixel = rgbd::Project(model, point_m).array().round();
    if (pixel.x() >= 0.0 && pixel.x() < model.width_px && pixel.y() >= 0.0 &&
        pixel.y() < model.height_px) {
      painter.Paint(i, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    }
  }
  return painter.TakeFrame();
}

}  // namespace palpate::experiment
