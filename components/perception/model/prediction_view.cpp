// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/prediction_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

bool IsSurface(const PredictedSurface& predicted) {
  const Eigen::Matrix3Xi& triangles = predicted.triangles;
  return triangles.cols() > 0 && predicted.vertices_m.allFinite() && triangles.minCoeff() >= 0 &&
         triangles.maxCoeff() < predicted.vertices_m.cols();
}

}  // namespace

PredictionView::PredictionView(const rgbd::RgbdCamera& camera, const ModelConfig& config,
                               const PredictionViewTuning& tuning)
    : config_(config),
      tuning_(tuning),
      focal_px_(std::max(camera.depth.fx_px, camera.depth.fy_px)),
      view_(camera.depth),
      fit_(tuning.fit) {}

Status PredictionView::Render(const PredictedSurface& predicted) {
  if (!IsSurface(predicted)) {
    return Status(StatusCode::kInvalidInput, "the predicted surface is empty or has no numbers");
  }
  surface_.vertices_m = predicted.vertices_m;
  all_triangles_ = predicted.triangles;
  surface_.triangles.resize(3, predicted.triangles.cols());
  Eigen::Index facing = 0;
  for (Eigen::Index t = 0; t < predicted.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = predicted.triangles.col(t);
    const Eigen::Vector3d a = surface_.vertices_m.col(corners[0]);
    const Eigen::Vector3d area =
        (surface_.vertices_m.col(corners[1]) - a).cross(surface_.vertices_m.col(corners[2]) - a);
    if (area.dot(a) < 0.0) surface_.triangles.col(facing++) = corners;
  }
  surface_.triangles.conservativeResize(3, facing);
  Redraw();
  if (view_.bounds().empty()) {
    return Status(StatusCode::kNoRobotSeen, "the predicted robot is out of the camera's view");
  }
  nearest_z_m_ = static_cast<float>(
      std::max(surface_.vertices_m.row(2).minCoeff(), rgbd::SurfaceView::kNearest_m));
  return Status::Ok();
}

void PredictionView::Redraw() {
  view_.Look(surface_.vertices_m, surface_.triangles);
  normals_.resize(3, surface_.triangles.cols());
  for (Eigen::Index t = 0; t < surface_.triangles.cols(); ++t) {
    const Eigen::Vector3d a = surface_.vertices_m.col(surface_.triangles(0, t));
    const Eigen::Vector3d area = (surface_.vertices_m.col(surface_.triangles(1, t)) - a)
                                     .cross(surface_.vertices_m.col(surface_.triangles(2, t)) - a);
    normals_.col(t) = area.normalized().cast<float>();
  }
}

PredictedSurface PredictionView::WholeSurface() const {
  return {surface_.vertices_m, all_triangles_};
}

void PredictionView::Place(PixelRegion* region) const {
  const auto& bounds = view_.bounds();
  const rgbd::CameraModel& camera = view_.camera();
  const double wide_px = config_.margin_m * focal_px_ / static_cast<double>(nearest_z_m_);
  const int margin_px = static_cast<int>(std::ceil(std::min(wide_px, 1e4)));
  const int u_begin = std::max(0, bounds.u_begin - margin_px);
  const int v_begin = std::max(0, bounds.v_begin - margin_px);
  const int u_end = std::min(camera.width_px, bounds.u_end + margin_px);
  const int v_end = std::min(camera.height_px, bounds.v_end + margin_px);
  region->Place(u_begin, v_begin, u_end - u_begin, v_end - v_begin);
}

void PredictionView::LayGrid(const Registration& registration, const PixelRegion& region) {
  const double step_px = tuning_.sample_spacing_m * focal_px_ / static_cast<double>(nearest_z_m_);
  const int step =
      std::clamp(static_cast<int>(step_px), tuning_.least_step_px, tuning_.most_step_px);
  grid_.Lay(region.width, region.height, step);
  for (int row = 0; row < grid_.rows; ++row) {
    for (int column = 0; column < grid_.columns; ++column) {
      const int u = region.u_begin + column * step, v = region.v_begin + row * step;
      const std::size_t at = grid_.At(column, row);
      const Eigen::Vector3f ray = registration.Ray(u, v);
      const float z_m = region.z_m[region.At(column * step, row * step)];
      if (z_m > 0.0f) grid_.measured_m[at] = z_m * ray;
      const int triangle = view_.Triangle(u, v);
      if (triangle == rgbd::SurfaceView::kNothing) continue;
      grid_.site_m[at] = view_.Z_m(u, v) * ray;
      grid_.normal[at] = normals_.col(triangle);
    }
  }
}

void PredictionView::FitTo(const Registration& registration, const PixelRegion& region,
                           const Fitting& fitting) {
  LayGrid(registration, region);
  for (int row = 0; row < grid_.rows; ++row) {
    for (int column = 0; column < grid_.columns; ++column) {
      Eigen::Vector3f& point_m = grid_.measured_m[grid_.At(column, row)];
      const int u = region.u_begin + column * grid_.step_px;
      const int v = region.v_begin + row * grid_.step_px;
      if (point_m.z() > 0.0f && fitting.is_foreign(u, v, point_m)) point_m.setZero();
    }
  }
  fit_.Lay(grid_, {.spacing_m = config_.fit_spacing_m,
                   .largest_error_m = fitting.largest_error_m,
                   .point_sigma_m = fitting.point_sigma_m});
  fit_.Fit(&grid_);
  for (Eigen::Index i = 0; i < surface_.vertices_m.cols(); ++i) {
    surface_.vertices_m.col(i) += fit_.At(surface_.vertices_m.col(i).cast<float>()).cast<double>();
  }
  Redraw();
  LayGrid(registration, region);
  FindNearestSites(&grid_);
}

PredictionView::Agreement PredictionView::Agree(const Registration& registration,
                                                const PixelRegion& region,
                                                const Fitting& fitting) const {
  const float near_m = tuning_.agree_sigmas * fitting.point_sigma_m;
  Agreement agreement;
  for (int row = 0; row < grid_.rows; ++row) {
    for (int column = 0; column < grid_.columns; ++column) {
      const std::size_t at = grid_.At(column, row);
      const int u = region.u_begin + column * grid_.step_px;
      const int v = region.v_begin + row * grid_.step_px;
      const Eigen::Vector3f point_m =
          region.z_m[region.At(column * grid_.step_px, row * grid_.step_px)] *
          registration.Ray(u, v);
      if (point_m.z() <= 0.0f) continue;
      const int nearest = grid_.nearest[at];
      const bool is_near = nearest != SampleGrid::kNone &&
                           (point_m - grid_.site_m[At(nearest)]).squaredNorm() < near_m * near_m;
      const float behind_m =
          grid_.site_m[at].z() > 0.0f ? grid_.normal[at].dot(grid_.site_m[at] - point_m) : 0.0f;
      agreement.agree += is_near ? 1 : 0;
      agreement.contradict += !is_near && behind_m > near_m ? 1 : 0;
      agreement.strange += !is_near && !fitting.is_foreign(u, v, point_m) ? 1 : 0;
    }
  }
  return agreement;
}

PredictionView::Distance PredictionView::From(const Eigen::Vector3f& site_m,
                                              const Eigen::Vector3f& normal,
                                              const Eigen::Vector3f& point_m, float slack_m) {
  const Eigen::Vector3f off_m = point_m - site_m;
  const float along_m = normal.dot(off_m);
  const float across_m2 = off_m.squaredNorm() - along_m * along_m;
  if (across_m2 <= slack_m * slack_m) return {along_m, along_m * along_m};
  const float across_m = std::sqrt(across_m2) - slack_m;
  return {along_m, along_m * along_m + across_m * across_m};
}

void PredictionView::Measure(const Registration& registration, PixelRegion* region) const {
  const int step = grid_.step_px;
  // Distance of sites; on a slope the nearest one is still nearer than that.
  const float on_surface_m2 = tuning_.on_surface_m2;
  const float slack_share = 1.5f * static_cast<float>(step / focal_px_);
  for (int row = 0; row < region->height; ++row) {
    for (int column = 0; column < region->width; ++column) {
      const std::size_t at = region->At(column, row);
      const float z_m = region->z_m[at];
      if (z_m <= 0.0f) continue;
      const int u = region->u_begin + column, v = region->v_begin + row;
      const Eigen::Vector3f ray = registration.Ray(u, v);
      const Eigen::Vector3f point_m = z_m * ray;
      const float slack_m = slack_share * z_m;
      Distance distance{1.0f, 1.0f};
      const int triangle = view_.Triangle(u, v);
      if (triangle != rgbd::SurfaceView::kNothing) {
        distance = From(view_.Z_m(u, v) * ray, normals_.col(triangle), point_m, slack_m);
      }
      const int site = grid_.nearest[grid_.At(column / step, row / step)];
      if (site != SampleGrid::kNone && distance.squared_m2 > on_surface_m2) {
        const auto k = static_cast<std::size_t>(site);
        const Distance there = From(grid_.site_m[k], grid_.normal[k], point_m, slack_m);
        if (there.squared_m2 < distance.squared_m2) distance = there;
      }
      const float size_m = std::sqrt(distance.squared_m2);
      region->distance_m[at] = distance.signed_m < 0.0f ? -size_m : size_m;
    }
  }
}

}  // namespace palpate::perception
