// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::view {

namespace {

int Cut(double value, int limit) {
  return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
}

void AddDiagonals(const Eigen::Vector2d& center_px, double arm_px, double radius_px,
                  CoverageMask* mask) {
  const Eigen::Vector2d rising(arm_px, -arm_px);
  const Eigen::Vector2d falling(arm_px, arm_px);
  mask->AddStroke(center_px - rising, center_px + rising, radius_px);
  mask->AddStroke(center_px - falling, center_px + falling, radius_px);
}

Rect Around(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double margin_px) {
  const Eigen::Vector2d lower = a.cwiseMin(b).array() - margin_px;
  const Eigen::Vector2d size = (a - b).cwiseAbs().array() + 2.0 * margin_px;
  return {lower.x(), lower.y(), size.x(), size.y()};
}

}  // namespace

CoverageMask::CoverageMask(const Rect& box, const Image& image)
    : left_px_(Cut(std::floor(box.x_px), image.width_px)),
      top_px_(Cut(std::floor(box.y_px), image.height_px)),
      width_px_(Cut(std::ceil(box.right_px()), image.width_px) - left_px_),
      height_px_(Cut(std::ceil(box.bottom_px()), image.height_px) - top_px_),
      coverage_(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_), 0.0) {}

void CoverageMask::AddStroke(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                             double radius_px) {
  const Eigen::Vector2d along = to_px - from_px;
  const double length_squared = std::max(along.squaredNorm(), 1e-12);
  const Rect reach = Around(from_px, to_px, radius_px + 1.0);
  const int first_x = Cut(std::floor(reach.x_px) - left_px_, width_px_);
  const int last_x = Cut(std::ceil(reach.right_px()) - left_px_, width_px_);
  const int first_y = Cut(std::floor(reach.y_px) - top_px_, height_px_);
  const int last_y = Cut(std::ceil(reach.bottom_px()) - top_px_, height_px_);
  for (int y = first_y; y < last_y; ++y) {
    for (int x = first_x; x < last_x; ++x) {
      const Eigen::Vector2d offset =
          Eigen::Vector2d(left_px_ + x + 0.5, top_px_ + y + 0.5) - from_px;
      const double t = std::clamp(offset.dot(along) / length_squared, 0.0, 1.0);
      const double distance_px = (offset - t * along).norm();
      const double covered = std::clamp(radius_px - distance_px + 0.5, 0.0, 1.0);
      double& pixel = coverage_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) +
                                static_cast<std::size_t>(x)];
      pixel = std::max(pixel, covered);
    }
  }
}

void CoverageMask::Paint(const Color& color, double opacity, Image* image) const {
  for (int y = 0; y < height_px_; ++y) {
    for (int x = 0; x < width_px_; ++x) {
      const double covered =
          coverage_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) +
                    static_cast<std::size_t>(x)];
      if (covered > 0.0) {
        image->Blend(left_px_ + x, top_px_ + y, color, opacity * covered);
      }
    }
  }
}

void DrawStroke(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double width_px,
                const Color& color, Image* image) {
  CoverageMask mask(Around(from_px, to_px, width_px + 1.0), *image);
  mask.AddStroke(from_px, to_px, 0.5 * width_px);
  mask.Paint(color, 1.0, image);
}

void FillRect(const Rect& rect, const Color& color, double opacity, Image* image) {
  const int left = Cut(std::round(rect.x_px), image->width_px);
  const int right = Cut(std::round(rect.right_px()), image->width_px);
  const int top = Cut(std::round(rect.y_px), image->height_px);
  const int bottom = Cut(std::round(rect.bottom_px()), image->height_px);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      image->Blend(x, y, color, opacity);
    }
  }
}

void DrawRing(const Eigen::Vector2d& center_px, double radius_px, double width_px,
              const Color& color, Image* image) {
  constexpr int kPieces = 48;
  const auto at = [&](int piece) {
    const double angle = 2.0 * std::numbers::pi * piece / kPieces;
    return Eigen::Vector2d(center_px +
                           radius_px * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  };
  CoverageMask mask(Around(center_px, center_px, radius_px + width_px + 1.0), *image);
  for (int piece = 0; piece < kPieces; ++piece) {
    mask.AddStroke(at(piece), at(piece + 1), 0.5 * width_px);
  }
  mask.Paint(color, 1.0, image);
}

void DrawCross(const Eigen::Vector2d& center_px, double arm_px, double width_px, const Color& color,
               Image* image) {
  const Rect box = Around(center_px, center_px, arm_px + width_px + 3.0);
  CoverageMask halo(box, *image);
  AddDiagonals(center_px, arm_px, 0.5 * width_px + 1.2, &halo);
  halo.Paint(palette::kPaper, 0.9, image);
  CoverageMask ink(box, *image);
  AddDiagonals(center_px, arm_px, 0.5 * width_px, &ink);
  ink.Paint(color, 1.0, image);
}

}  // namespace palpate::view
