// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/view/picture/camera.hpp"
#include "components/view/picture/color.hpp"
#include "components/view/picture/image.hpp"

namespace palpate::view {

/// Smooth-edged strokes over a finished image: collects how much of each pixel is covered, then
/// paints once, so that strokes that meet do not darken each other.
class CoverageMask {
 public:
  /// For strokes inside `box` (cut to the image).
  CoverageMask(const Rect& box, const Image& image);

  /// A line with round ends of the given radius; from == to is a disc.
  void AddStroke(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double radius_px);

  void Paint(const Color& color, double opacity, Image* image) const;

 private:
  int left_px_;
  int top_px_;
  int width_px_;
  int height_px_;
  std::vector<double> coverage_;
};

/// One stroke with round ends.
void DrawStroke(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double width_px,
                const Color& color, Image* image);

/// A filled rectangle, its edges rounded to whole pixels, cut to the image.
void FillRect(const Rect& rect, const Color& color, double opacity, Image* image);

/// A circle line.
void DrawRing(const Eigen::Vector2d& center_px, double radius_px, double width_px,
              const Color& color, Image* image);

/// A cross of two diagonal strokes in a halo, centred at `center_px`.
void DrawCross(const Eigen::Vector2d& center_px, double arm_px, double width_px, const Color& color,
               Image* image);

}  // namespace palpate::view
