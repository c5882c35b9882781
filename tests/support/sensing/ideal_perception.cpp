// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/ideal_perception.hpp"

#include <cmath>
#include <utility>

#include "libs/core/seconds.hpp"

namespace palpate::test_support {

namespace {

constexpr float kSameSurface_m = 2e-4f;  ///< the camera draws to 0.01 mm
constexpr float kDepthEdge = 0.01f;      ///< share of z between neighbouring pixels
constexpr int kBlock_px = 2;

rgbd::DepthNoise NoiseOf(const scenario::DepthNoise& noise) {
  return {.subpixel_px = noise.subpixel_px,
          .range_sigma_m = noise.range_sigma_m,
          .correlation_px = noise.correlation_px};
}

/// Sums of the points of one block.
struct BlockSum {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  int count = 0;
};

}  // namespace

IdealPerception::IdealPerception(const SensingScene& scene, std::size_t camera)
    : scene_{scene},
      camera_{camera},
      noise_{NoiseOf(scene.spec(camera).noise)},
      view_{scene.camera(camera).depth} {}

const std::vector<TrueLabel>& IdealPerception::Labels() {
  view_.Look(scene_.NodesInCamera_m(camera_), scene_.triangles());
  const rgbd::RangeImage& truth = scene_.true_range(camera_);
  labels_.assign(truth.values.size(), TrueLabel::kElse);
  std::size_t at = 0;
  for (int v = 0; v < truth.height_px; ++v) {
    for (int u = 0; u < truth.width_px; ++u, ++at) {
      if (view_.Triangle(u, v) == rgbd::SurfaceView::kNothing) continue;
      const bool same = std::abs(truth.values[at] - view_.Z_m(u, v)) < kSameSurface_m;
      if (same) labels_[at] = TrueLabel::kRobot;
    }
  }
  return labels_;
}

bool IdealPerception::IsWellInside(int u_px, int v_px) const {
  const rgbd::RangeImage& truth = scene_.true_range(camera_);
  if (u_px < 1 || v_px < 1 || u_px + 1 >= truth.width_px || v_px + 1 >= truth.height_px) {
    return false;
  }
  const float z_m = *truth.Pixel(u_px, v_px);
  for (int v = v_px - 1; v <= v_px + 1; ++v) {
    for (int u = u_px - 1; u <= u_px + 1; ++u) {
      const auto at = static_cast<std::size_t>(v) * static_cast<std::size_t>(truth.width_px) +
                      static_cast<std::size_t>(u);
      if (labels_[at] != TrueLabel::kRobot) return false;
      if (std::abs(truth.values[at] - z_m) > kDepthEdge * z_m) return false;
    }
  }
  return true;
}

rgbd::SensedCloud IdealPerception::Cloud() {
  Labels();
  const rgbd::RgbdCamera& camera = scene_.camera(camera_);
  const rgbd::RgbdFrame& frame = scene_.frame(camera_);
  const bool colored = frame.color.width_px == frame.depth.width_px;
  std::vector<BlockSum> blocks;
  for (int v0 = 0; v0 + 1 < frame.depth.height_px; v0 += kBlock_px) {
    for (int u0 = 0; u0 + 1 < frame.depth.width_px; u0 += kBlock_px) {
      BlockSum sum;
      for (int k = 0; k < kBlock_px * kBlock_px; ++k) {
        const int u = u0 + k % kBlock_px;
        const int v = v0 + k / kBlock_px;
        const int raw = *frame.depth.Pixel(u, v);
        if (raw == camera.invalid_value || !IsWellInside(u, v)) continue;
        sum.point_m += raw * camera.depth_unit_m * rgbd::Unproject(camera.depth, {u, v});
        if (colored) {
          const std::uint8_t* rgb = frame.color.Pixel(u, v);
          sum.color += Eigen::Vector3d(rgb[0], rgb[1], rgb[2]);
        }
        ++sum.count;
      }
      if (sum.count > 0) blocks.push_back(sum);
    }
  }
  rgbd::SensedCloud cloud;
  cloud.points_m.resize(3, static_cast<Eigen::Index>(blocks.size()));
  cloud.sigma_m.resize(cloud.points_m.cols());
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const double count = blocks[k].count;
    const Eigen::Vector3d point_m = blocks[k].point_m / count;
    cloud.points_m.col(column) = point_m.cast<float>();
    cloud.sigma_m[column] = static_cast<float>(rgbd::DepthSigma_m(camera, noise_, point_m.z()) /
                                               std::sqrt(rgbd::IndependentPixels(noise_, count)));
    for (int i = 0; i < 3; ++i) {
      cloud.colors_rgb.push_back(static_cast<std::uint8_t>(blocks[k].color[i] / count));
    }
  }
  return cloud;
}

std::vector<force_estimation::SeenContact> IdealPerception::Contacts(double sigma_m,
                                                                     const LocationError& error,
                                                                     bool weights) const {
  std::vector<force_estimation::SeenContact> contacts;
  for (const virtual_robot::TrueForce& force : scene_.state().forces) {
    bool of_tool = weights;
    for (const scenario::Tool& tool : scene_.scenario().tools) of_tool |= tool.name == force.name;
    if (!of_tool) continue;
    force_estimation::SeenContact& contact = contacts.emplace_back();
    contact.name = force.name;
    contact.position_m = force.position_m + error(force.name);
    contact.covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    contact.point_count = 100;
  }
  return contacts;
}

force_estimation::ShapeView IdealPerception::View() {
  return {Cloud(), scene_.T_robot_camera(camera_)};
}

force_estimation::ShapeFrame IdealPerception::Frame(
    std::vector<force_estimation::SeenContact> contacts) {
  force_estimation::ShapeFrame frame;
  frame.t_s = NsToSeconds(scene_.frame().stamp_ns);
  frame.views[0] = View();
  frame.contacts = std::move(contacts);
  frame.cables = scene_.Cables();
  return frame;
}

}  // namespace palpate::test_support
