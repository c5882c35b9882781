// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/color/color_segmenter.hpp"

#include <algorithm>
#include <cmath>

#include "components/perception/color/color_regions.hpp"
#include "components/perception/contacts/point_grid.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/rgbd/depth_noise.hpp"

namespace palpate::perception {

namespace {

/// The colour without its brightness; black counts as grey.
Eigen::Vector3d Direction(const Eigen::Vector3d& rgb) {
  return (rgb + Eigen::Vector3d::Ones()).normalized();
}

double ShareOf(const std::vector<int>& region, const std::vector<char>& marked) {
  const auto count = std::count_if(region.begin(), region.end(),
                                   [&](int point) { return marked[At(point)] != 0; });
  return static_cast<double>(count) / static_cast<double>(region.size());
}

}  // namespace

ColorSegmenter::ColorSegmenter(const Config& config, const ColorSegmenterTuning& tuning)
    : config_(config), tuning_(tuning) {
  if (const auto rgb = RobotColor(config)) robot_color_ = Direction(255.0 * *rgb);
}

void ColorSegmenter::SetCamera(const rgbd::RgbdCamera& camera) {
  registration_ = std::make_unique<Registration>(camera);
  view_ = std::make_unique<rgbd::SurfaceView>(camera.depth);
}

const SegmentedFrame& ColorSegmenter::Segment(const rgbd::RgbdFrame& frame,
                                              const PredictedSurface* predicted) {
  PALPATE_CHECK(registration_ != nullptr);
  segmented_ = {};
  const auto fail = [this](Status status) -> const SegmentedFrame& {
    segmented_.status = std::move(status);
    return segmented_;
  };
  if (Status status = registration_->Register(frame, &registered_); !status.ok()) {
    return fail(std::move(status));
  }
  const VoxelCloud cloud =
      FilterFrame(registered_, *registration_, Bounds(predicted), config_, &segmented_.rejected);
  if (cloud.Count() == 0)
    return fail({StatusCode::kNoRobotSeen, "no coloured depth within the limits"});
  MarkOnSurface(cloud, predicted);
  EstimateColor(cloud);
  if (!robot_color_) {
    return fail({StatusCode::kNoRobotSeen,
                 "the robot's colour is neither set nor was it seen on the predicted surface"});
  }
  const std::vector<std::vector<int>> regions = GrowRegions(cloud, config_.color);
  labels_.assign(static_cast<std::size_t>(cloud.Count()), Label::kNothing);
  LabelRobot(cloud, regions);
  segmented_.robot = Take(cloud, Label::kRobot);
  if (segmented_.robot.Count() == 0) {
    return fail({StatusCode::kNoRobotSeen, "nothing has the robot's colour"});
  }
  LabelObjects(cloud, regions);
  segmented_.object = Take(cloud, Label::kObject);
  segmented_.status = Status::Ok();
  return segmented_;
}

geometry::Box ColorSegmenter::Bounds(const PredictedSurface* predicted) const {
  const double side_m = config_.color.side_m;
  geometry::Box box{{-side_m, -side_m, config_.min_z_m}, {side_m, side_m, config_.max_z_m}};
  if (predicted != nullptr && predicted->vertices_m.cols() > 0) {
    const geometry::Box robot = geometry::BoundingBox(predicted->vertices_m);
    box.lower_m =
        box.lower_m.cwiseMax((robot.lower_m.array() - config_.color.near_robot_m).matrix());
    box.upper_m =
        box.upper_m.cwiseMin((robot.upper_m.array() + config_.color.near_robot_m).matrix());
  }
  return box;
}

void ColorSegmenter::MarkOnSurface(const VoxelCloud& cloud, const PredictedSurface* predicted) {
  on_surface_.assign(static_cast<std::size_t>(cloud.Count()), 0);
  if (predicted == nullptr) return;
  view_->Look(predicted->vertices_m, predicted->triangles);
  const rgbd::CameraModel& camera = view_->camera();
  for (int i = 0; i < cloud.Count(); ++i) {
    const Eigen::Vector3d point_m = cloud.points_m.col(i).cast<double>();
    const Eigen::Vector2d pixel = rgbd::Project(camera, point_m).array().round();
    const bool inside =
        (pixel.array() >= 0.0).all() && pixel.x() < camera.width_px && pixel.y() < camera.height_px;
    if (!inside) continue;
    const auto z_m =
        static_cast<double>(view_->Z_m(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())));
    const bool near = std::abs(point_m.z() - z_m) <= config_.color.surface_distance_m;
    on_surface_[At(i)] = near ? 1 : 0;
  }
}

/// Median over the predicted surface, robust against a tool before it or a marker on it. Kept for
/// frames without a prediction.
void ColorSegmenter::EstimateColor(const VoxelCloud& cloud) {
  if (!config_.robot_color_rgb.empty()) return;
  std::vector<double> channels[3];
  for (int i = 0; i < cloud.Count(); ++i) {
    if (on_surface_[At(i)] == 0) continue;
    const Eigen::Vector3d direction = Direction(cloud.Color(i));
    for (int k = 0; k < 3; ++k) channels[k].push_back(direction[k]);
  }
  if (channels[0].size() < tuning_.fewest_color_voxels) return;
  Eigen::Vector3d median;
  for (int k = 0; k < 3; ++k) median[k] = UpperMedian(channels[k]);
  robot_color_ = median.normalized();
}

bool ColorSegmenter::IsRobot(const VoxelCloud& cloud, const std::vector<int>& region) const {
  if (ShareOf(region, on_surface_) > tuning_.region_share) return true;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int point : region) sum += cloud.Color(point);
  const Eigen::Vector3d color = Direction(sum / static_cast<double>(region.size()));
  return (color - *robot_color_).norm() <= config_.color.robot_color_tolerance;
}

void ColorSegmenter::LabelRobot(const VoxelCloud& cloud,
                                const std::vector<std::vector<int>>& regions) {
  for (const std::vector<int>& region : regions) {
    if (!IsRobot(cloud, region)) continue;
    for (const int point : region) labels_[At(point)] = Label::kRobot;
  }
}

void ColorSegmenter::LabelObjects(const VoxelCloud& cloud,
                                  const std::vector<std::vector<int>>& regions) {
  const auto near_m = static_cast<float>(config_.color.near_robot_m);
  PointGrid robot;
  robot.Build(segmented_.robot.points_m, near_m);
  std::vector<char> in_region(static_cast<std::size_t>(cloud.Count()), 0);
  for (const std::vector<int>& region : regions) {
    for (const int point : region) in_region[At(point)] = 1;
    if (labels_[At(region.front())] == Label::kRobot) continue;
    for (const int point : region) {
      bool near = false;
      robot.ForEachNear(cloud.points_m.col(point), near_m, [&](int, float) {
        near = true;
        return false;
      });
      if (near) labels_[At(point)] = Label::kObject;
    }
  }
  for (int i = 0; i < cloud.Count(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (in_region[k] == 0) segmented_.rejected.ambiguous += cloud.pixels[k];
  }
}

rgbd::SensedCloud ColorSegmenter::Take(const VoxelCloud& cloud, Label label) const {
  const rgbd::DepthNoise noise = NoiseOf(config_);
  rgbd::SensedCloud taken;
  const auto count = std::count(labels_.begin(), labels_.end(), label);
  taken.points_m.resize(3, count);
  taken.sigma_m.resize(count);
  Eigen::Index next = 0;
  for (int i = 0; i < cloud.Count(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (labels_[k] != label) continue;
    const double pixel_m = rgbd::DepthSigma_m(registration_->camera(), noise,
                                              static_cast<double>(cloud.points_m(2, i)));
    const double independent = rgbd::IndependentPixels(noise, cloud.pixels[k]);
    taken.points_m.col(next) = cloud.points_m.col(i);
    taken.sigma_m[next] = static_cast<float>(pixel_m / std::sqrt(independent));
    const auto* rgb = cloud.colors_rgb.data() + 3 * k;
    taken.colors_rgb.insert(taken.colors_rgb.end(), rgb, rgb + 3);
    ++next;
  }
  return taken;
}

}  // namespace palpate::perception
