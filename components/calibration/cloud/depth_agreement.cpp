// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/depth_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "components/calibration/joint/solved_state.hpp"
#include "components/calibration/model_tolerance.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/rgbd/surface_view.hpp"

namespace palpate::calibration {

namespace {

struct DepthAgreementTuning {
  int most_pixels = 320;      ///< along the longer side; more: slower, thinner robots
  double least_pixels = 20;   ///< of the robot, below which an image tells nothing
  double sigmas = 3.0;        ///< distance from the surface that agrees
  double depth_bias = 0.005;  ///< standard deviation of a depth camera's bias, share of z
  double grazing = 0.2;       ///< cosine below which a surface is not compared
  int rim_px = 3;             ///< distance beyond the outline at which the surface must end
  double nearer_weight = 0.5;
  double least_in_view = 0.5;  ///< share of the robot in the image that is no misfit yet
};
constexpr DepthAgreementTuning kAgreementTuning;

int StepOf(const rgbd::CameraModel& camera) {
  const int longer_px = std::max(camera.width_px, camera.height_px);
  return std::max(1, (longer_px + kAgreementTuning.most_pixels - 1) / kAgreementTuning.most_pixels);
}

/// Each `step_px`-th pixel of a lens.
rgbd::CameraModel EachOf(rgbd::CameraModel lens, int step_px) {
  lens.width_px = (lens.width_px + step_px - 1) / step_px;
  lens.height_px = (lens.height_px + step_px - 1) / step_px;
  for (double* value : {&lens.fx_px, &lens.fy_px, &lens.cx_px, &lens.cy_px}) *value /= step_px;
  return lens;
}

rgbd::RangeImage RangesOf(const DepthSight& sight, const rgbd::CameraModel& lens, int step_px) {
  rgbd::RangeImage z_m(lens.width_px, lens.height_px);
  for (int v = 0; v < lens.height_px; ++v) {
    for (int u = 0; u < lens.width_px; ++u) {
      const int value = *sight.depth.Pixel(u * step_px, v * step_px);
      const bool known = value != 0 && value != sight.camera.invalid_value;
      *z_m.Pixel(u, v) = known ? static_cast<float>(value * sight.camera.depth_unit_m) : 0.0f;
    }
  }
  return z_m;
}

}  // namespace

double DepthAgreement::Misfit() const {
  const double seen = agree + farther + kAgreementTuning.nearer_weight * nearer;
  if (seen < kAgreementTuning.least_pixels) return 1.0;
  const double ends = rims > 0.0 ? 1.0 - open_rims / rims : 1.0;
  return 1.0 - agree / seen * ends * std::min(1.0, in_view / kAgreementTuning.least_in_view);
}

DepthComparison::DepthComparison(const robot::RobotBody& body, const Eigen::VectorXd& rest_m,
                                 const DepthSight& sight)
    : sight_(sight),
      rest_m_(rest_m),
      triangles_(body.boundary.DrawnTriangles()),
      motion_m_((sight.x_m - rest_m).reshaped(3, rest_m.size() / 3).colwise().norm().transpose()),
      extent_m_(ExtentOf(rest_m)),
      step_px_(StepOf(sight.camera.depth)),
      lens_(EachOf(sight.camera.depth, step_px_)),
      z_m_(RangesOf(sight, lens_, step_px_)) {}

rgbd::CameraModel DepthComparison::LensOf(const Mend& mend) const {
  rgbd::CameraModel lens = lens_;
  lens.fx_px *= mend.lens;
  lens.fy_px *= mend.lens;
  // Images of another size begin at the edge of their first pixel.
  const double edge_px = 0.5 / step_px_;
  lens.cx_px = (lens.cx_px + edge_px) * mend.lens - edge_px;
  lens.cy_px = (lens.cy_px + edge_px) * mend.lens - edge_px;
  return lens;
}

Eigen::VectorXd DepthComparison::ShapeOf(const Mend& mend) const {
  return mend.body * (rest_m_ + mend.motion * (sight_.x_m - rest_m_));
}

double DepthComparison::Tolerance_m(double z_m, double motion_m, const Mend& mend) const {
  rgbd::RgbdCamera camera = sight_.camera;
  camera.depth_unit_m *= mend.depth;
  const double noise_m = rgbd::DepthSigma_m(camera, sight_.noise, z_m);
  const double bias_m = kAgreementTuning.depth_bias * z_m;
  return kAgreementTuning.sigmas *
         std::sqrt(noise_m * noise_m + bias_m * bias_m + ModelVariance_m2(extent_m_, motion_m));
}

DepthAgreement DepthComparison::Compare(const geometry::RigidTransform& T_robot_camera,
                                        const Mend& mend) const {
  const Eigen::VectorXd x_m = ShapeOf(mend);
  const Eigen::Matrix3Xd nodes_m = T_robot_camera.Inverse().Apply(x_m.reshaped(3, x_m.size() / 3));
  const rgbd::CameraModel lens = LensOf(mend);
  rgbd::SurfaceView view(lens);
  view.Look(nodes_m, triangles_);
  DepthAgreement agreement;
  double vertices = 0.0;
  for (const int node : triangles_.reshaped()) {
    const Eigen::Vector3d place_m = nodes_m.col(node);
    ++vertices;
    if (place_m.z() < rgbd::SurfaceView::kNearest_m) continue;
    const Eigen::Vector2d pixel_px = rgbd::Project(lens, place_m);
    const bool inside = (pixel_px.array() >= 0.0).all() && pixel_px.x() <= lens.width_px - 1 &&
                        pixel_px.y() <= lens.height_px - 1;
    agreement.in_view += inside ? 1.0 : 0.0;
  }
  agreement.in_view /= std::max(1.0, vertices);
  const auto& bounds = view.bounds();
  for (int v = bounds.v_begin; v < bounds.v_end; ++v) {
    for (int u = bounds.u_begin; u < bounds.u_end; ++u) {
      const int triangle = view.Triangle(u, v);
      const double measured_m = mend.depth * static_cast<double>(*z_m_.Pixel(u, v));
      if (triangle == rgbd::SurfaceView::kNothing || measured_m <= 0.0) continue;
      const Eigen::Vector3i corners = triangles_.col(triangle);
      const Eigen::Vector3d a = nodes_m.col(corners[0]);
      const Eigen::Vector3d normal =
          (nodes_m.col(corners[1]) - a).cross(nodes_m.col(corners[2]) - a).normalized();
      const double cosine = std::abs(normal.dot(a)) / a.norm();
      if (cosine < kAgreementTuning.grazing) continue;
      const double expected_m = static_cast<double>(view.Z_m(u, v));
      const double tolerance_m = Tolerance_m(expected_m, mend.motion * motion_m_[corners[0]], mend);
      const double beyond_m = cosine * (measured_m - expected_m);
      if (std::abs(beyond_m) > tolerance_m) {
        (beyond_m > 0.0 ? agreement.farther : agreement.nearer) += 1.0;
        continue;
      }
      agreement.agree += 1.0;
      constexpr int kRim_px = kAgreementTuning.rim_px;
      for (const auto& [du, dv] :
           {std::pair{kRim_px, 0}, {-kRim_px, 0}, {0, kRim_px}, {0, -kRim_px}}) {
        const bool inside =
            u + du >= 0 && v + dv >= 0 && u + du < lens.width_px && v + dv < lens.height_px;
        if (!inside || view.Triangle(u + du, v + dv) != rgbd::SurfaceView::kNothing) continue;
        const double there_m = mend.depth * static_cast<double>(*z_m_.Pixel(u + du, v + dv));
        if (there_m <= 0.0) continue;
        agreement.rims += 1.0;
        agreement.open_rims += std::abs(there_m - measured_m) < tolerance_m ? 1.0 : 0.0;
      }
    }
  }
  return agreement;
}

ThinCloud DepthComparison::CloudNear(const geometry::RigidTransform& T_robot_camera,
                                     const Mend& mend, double reach_m, double spacing_m) const {
  const Eigen::VectorXd x_m = ShapeOf(mend);
  const Eigen::Matrix3Xd nodes_m = x_m.reshaped(3, x_m.size() / 3);
  const Eigen::Vector3d low_m = nodes_m.rowwise().minCoeff();
  const Eigen::Vector3d high_m = nodes_m.rowwise().maxCoeff();
  const rgbd::CameraModel lens = LensOf(mend);
  std::vector<Eigen::Vector3f> points_m;
  for (int v = 0; v < lens.height_px; ++v) {
    for (int u = 0; u < lens.width_px; ++u) {
      const double z_m = mend.depth * static_cast<double>(*z_m_.Pixel(u, v));
      if (z_m <= 0.0) continue;
      const Eigen::Vector3d point_m =
          z_m * rgbd::Unproject(lens, {static_cast<double>(u), static_cast<double>(v)});
      const Eigen::Vector3d there_m = T_robot_camera * point_m;
      const Eigen::Vector3d off_m = there_m - there_m.cwiseMax(low_m).cwiseMin(high_m);
      if (off_m.norm() < reach_m) points_m.push_back(point_m.cast<float>());
    }
  }
  rgbd::SensedCloud cloud;
  cloud.points_m.resize(3, ToIndex(points_m.size()));
  cloud.sigma_m.resize(ToIndex(points_m.size()));
  for (std::size_t k = 0; k < points_m.size(); ++k) {
    cloud.points_m.col(ToIndex(k)) = points_m[k];
    const auto z_m = static_cast<double>(points_m[k].z());
    cloud.sigma_m[ToIndex(k)] =
        static_cast<float>(rgbd::DepthSigma_m(sight_.camera, sight_.noise, z_m));
  }
  return points_m.empty() ? ThinCloud{Eigen::Matrix3Xd(3, 0), Eigen::VectorXd(0)}
                          : Thin(cloud, spacing_m);
}

double DepthComparison::DepthRatio(const geometry::RigidTransform& T_robot_camera) const {
  const Eigen::VectorXd x_m = ShapeOf({});
  rgbd::SurfaceView view(lens_);
  view.Look(T_robot_camera.Inverse().Apply(x_m.reshaped(3, x_m.size() / 3)), triangles_);
  std::vector<double> ratios;
  const auto& bounds = view.bounds();
  for (int v = bounds.v_begin; v < bounds.v_end; ++v) {
    for (int u = bounds.u_begin; u < bounds.u_end; ++u) {
      const auto measured_m = static_cast<double>(*z_m_.Pixel(u, v));
      if (view.Triangle(u, v) == rgbd::SurfaceView::kNothing || measured_m <= 0.0) continue;
      ratios.push_back(measured_m / static_cast<double>(view.Z_m(u, v)));
    }
  }
  return ratios.empty() ? std::numeric_limits<double>::quiet_NaN() : Median(std::move(ratios));
}

}  // namespace palpate::calibration
