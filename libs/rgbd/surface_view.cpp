// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/surface_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::rgbd {

namespace {

/// Neighbouring triangles overlap by rounding rather than leave a gap.
constexpr double kSlack_px = 1e-9;

int Ceiling(double value) {
  const int whole = static_cast<int>(value);
  return whole < value ? whole + 1 : whole;
}

/// Pixel centres of 0 .. size - 1 between p, p + a and p + b.
struct Range {
  Range(double p, double a, double b, int size) {
    const double low = p + std::min(0.0, std::min(a, b)) - kSlack_px;
    const double high = p + std::max(0.0, std::max(a, b)) + kSlack_px;
    if (high < 0.0 || low > size - 1) return;
    begin = low > 0.0 ? Ceiling(low) : 0;
    end = high < size - 1 ? static_cast<int>(high) + 1 : size;
  }
  bool empty() const { return begin >= end; }

  int begin = 0;
  int end = 0;
};

/// Where a row crosses a triangle: x between two lines in y on either side.
class Span {
 public:
  Span(double low, double high) {
    low_.fill({low, 0.0});
    high_.fill({high, 0.0});
  }

  /// share.x x + share.y y + at_origin >= 0. Level edges are the business of the rows.
  void Bound(const Eigen::Vector2d& share, double at_origin) {
    constexpr double kLevel = 1e-12;
    if (std::abs(share.x()) <= kLevel * std::abs(share.y())) return;
    const Line line{-at_origin / share.x(), -share.y() / share.x()};
    if (share.x() > 0.0) {
      low_[lows_++] = line;
    } else {
      high_[highs_++] = line;
    }
  }

  double First(double y) const { return std::max(low_[0].At(y), low_[1].At(y)); }
  double Last(double y) const { return std::min(high_[0].At(y), high_[1].At(y)); }

 private:
  struct Line {
    double at_origin;
    double slope;
    double At(double y) const { return at_origin + slope * y; }
  };

  std::array<Line, 2> low_;  // three shares that add up to 1 do not all rise
  std::array<Line, 2> high_;
  std::size_t lows_ = 0;
  std::size_t highs_ = 0;
};

}  // namespace

SurfaceView::SurfaceView(const CameraModel& camera)
    : camera_(camera),
      triangle_(Index(0, camera.height_px), kNothing),
      inverse_z_(triangle_.size(), 0.0f) {}

void SurfaceView::Look(const Eigen::Ref<const Eigen::Matrix3Xd>& vertices_m,
                       const Eigen::Ref<const Eigen::Matrix3Xi>& triangles) {
  Clear();
  on_image_px_.resize(2, vertices_m.cols());
  vertex_inverse_z_.resize(vertices_m.cols());
  for (Eigen::Index k = 0; k < vertices_m.cols(); ++k) {
    const Eigen::Vector3d point = vertices_m.col(k);
    const bool in_front = point.z() >= kNearest_m;
    vertex_inverse_z_[k] = in_front ? 1.0 / point.z() : 0.0;
    if (in_front) on_image_px_.col(k) = Project(camera_, point);
  }
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    Draw(static_cast<int>(t), triangles.col(t));
  }
}

/// Only what the last Look has drawn.
void SurfaceView::Clear() {
  for (int v = bounds_.v_begin; v < bounds_.v_end; ++v) {
    const auto first = ToIndex(Index(bounds_.u_begin, v));
    const auto last = ToIndex(Index(bounds_.u_end, v));
    std::fill(triangle_.begin() + first, triangle_.begin() + last, kNothing);
    std::fill(inverse_z_.begin() + first, inverse_z_.begin() + last, 0.0f);
  }
  bounds_ = {};
}

void SurfaceView::Draw(int triangle, const Eigen::Vector3i& corners) {
  const Eigen::Vector2d p = on_image_px_.col(corners[0]);
  const Eigen::Vector2d a = on_image_px_.col(corners[1]) - p;
  const Eigen::Vector2d b = on_image_px_.col(corners[2]) - p;
  const Eigen::Vector3d inverse_z(vertex_inverse_z_[corners[0]], vertex_inverse_z_[corners[1]],
                                  vertex_inverse_z_[corners[2]]);
  if (inverse_z.minCoeff() <= 0.0) return;
  const double area = a.x() * b.y() - a.y() * b.x();
  if (area == 0.0 || !std::isfinite(area)) return;
  const Range columns(p.x(), a.x(), b.x(), camera_.width_px);
  const Range rows(p.y(), a.y(), b.y(), camera_.height_px);
  if (columns.empty() || rows.empty()) return;
  Grow(columns.begin, columns.end, rows.begin, rows.end);
  // About corner 0: shares of the corners 1 and 2, and 1/z, are linear in the image.
  const Eigen::Vector2d share_b = Eigen::Vector2d(b.y(), -b.x()) / area;
  const Eigen::Vector2d share_c = Eigen::Vector2d(-a.y(), a.x()) / area;
  const Eigen::Vector2d slope =
      share_b * (inverse_z[1] - inverse_z[0]) + share_c * (inverse_z[2] - inverse_z[0]);
  const double low = columns.begin;
  const double high = columns.end - 1;
  Span span(low - p.x(), high - p.x());
  span.Bound(share_b, 0.0);
  span.Bound(share_c, 0.0);
  span.Bound(-share_b - share_c, 1.0);
  for (int v = rows.begin; v < rows.end; ++v) {
    const double y = v - p.y();
    const double first = std::max(span.First(y) + p.x() - kSlack_px, low);
    const double last = std::min(span.Last(y) + p.x() + kSlack_px, high);
    if (last < first) continue;
    const double at_left = inverse_z[0] + slope.y() * y - slope.x() * p.x();
    float* nearest = inverse_z_.data() + Index(0, v);
    int* seen = triangle_.data() + Index(0, v);
    const int end = static_cast<int>(last) + 1;
    for (int u = Ceiling(first); u < end; ++u) {
      const auto here = static_cast<float>(at_left + slope.x() * u);
      const bool nearer = here > nearest[u];
      nearest[u] = nearer ? here : nearest[u];
      seen[u] = nearer ? triangle : seen[u];
    }
  }
}

void SurfaceView::Grow(int u_begin, int u_end, int v_begin, int v_end) {
  if (bounds_.empty()) {
    bounds_ = {u_begin, v_begin, u_end, v_end};
    return;
  }
  bounds_.u_begin = std::min(bounds_.u_begin, u_begin);
  bounds_.v_begin = std::min(bounds_.v_begin, v_begin);
  bounds_.u_end = std::max(bounds_.u_end, u_end);
  bounds_.v_end = std::max(bounds_.v_end, v_end);
}

}  // namespace palpate::rgbd
