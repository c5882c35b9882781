// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/texture/texture_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "components/perception/texture/texture_patch.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

/// Equal cells over what was drawn.
class CellGrid {
 public:
  CellGrid(const rgbd::SurfaceView& view, int most)
      : bounds_(view.bounds()),
        side_px_(
            std::max(TexturePatch::kHalf_px, static_cast<int>(std::sqrt(Covered(view) / most)))),
        columns_((bounds_.u_end - bounds_.u_begin) / side_px_ + 1),
        rows_((bounds_.v_end - bounds_.v_begin) / side_px_ + 1) {}

  int count() const { return columns_ * rows_; }
  int side_px() const { return side_px_; }
  Eigen::Vector2i Corner_px(int cell) const {
    return {bounds_.u_begin + cell % columns_ * side_px_,
            bounds_.v_begin + cell / columns_ * side_px_};
  }
  /// Nothing outside of the grid.
  std::optional<int> CellOf(const Eigen::Vector2d& place_px) const {
    const double column = std::floor((place_px.x() - bounds_.u_begin) / side_px_);
    const double row = std::floor((place_px.y() - bounds_.v_begin) / side_px_);
    const bool inside = column >= 0.0 && row >= 0.0 && column < columns_ && row < rows_;
    if (!inside) return std::nullopt;
    return static_cast<int>(row) * columns_ + static_cast<int>(column);
  }

 private:
  static double Covered(const rgbd::SurfaceView& view) {
    std::int64_t pixels = 0;
    const rgbd::SurfaceView::Bounds& bounds = view.bounds();
    for (int v = bounds.v_begin; v < bounds.v_end; ++v) {
      for (int u = bounds.u_begin; u < bounds.u_end; ++u) {
        pixels += view.Triangle(u, v) != rgbd::SurfaceView::kNothing ? 1 : 0;
      }
    }
    return static_cast<double>(pixels);
  }

  rgbd::SurfaceView::Bounds bounds_;
  int side_px_;
  int columns_;
  int rows_;
};

/// Whether one whole piece of the surface fills a patch there.
bool IsWhole(const rgbd::SurfaceView& view, int u_px, int v_px, float largest_step_m) {
  constexpr int kReach_px = TexturePatch::kHalf_px + 1;
  const rgbd::CameraModel& lens = view.camera();
  if (u_px < kReach_px || v_px < kReach_px || u_px + kReach_px >= lens.width_px ||
      v_px + kReach_px >= lens.height_px) {
    return false;
  }
  const float z_m = view.Z_m(u_px, v_px);
  for (int v = v_px - kReach_px; v <= v_px + kReach_px; v += kReach_px / 2) {
    for (int u = u_px - kReach_px; u <= u_px + kReach_px; u += kReach_px / 2) {
      if (view.Triangle(u, v) == rgbd::SurfaceView::kNothing) return false;
      if (std::abs(view.Z_m(u, v) - z_m) > largest_step_m) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Eigen::Vector2i> SeedPlaces_px(const GrayWindow& window, const rgbd::SurfaceView& view,
                                           const std::vector<Eigen::Vector2d>& taken_px, int most,
                                           const TextureSeedsTuning& tuning) {
  const CellGrid grid(view, most);
  std::vector<char> taken(At(grid.count()), 0);
  for (const Eigen::Vector2d& place_px : taken_px) {
    if (const auto cell = grid.CellOf(place_px)) taken[At(*cell)] = 1;
  }
  std::vector<Eigen::Vector2i> seeds_px;
  for (int cell = 0; cell < grid.count(); ++cell) {
    if (taken[At(cell)] != 0) continue;
    std::optional<Eigen::Vector2i> best_px;
    float strongest = tuning.least_gradient * tuning.least_gradient;
    const Eigen::Vector2i corner_px = grid.Corner_px(cell);
    for (int v = corner_px.y(); v < corner_px.y() + grid.side_px(); v += tuning.step_px) {
      for (int u = corner_px.x(); u < corner_px.x() + grid.side_px(); u += tuning.step_px) {
        if (!IsWhole(view, u, v, tuning.largest_step_m)) continue;
        const float strength = TexturePatch(window, u, v).Strength();
        if (strength <= strongest) continue;
        strongest = strength;
        best_px = Eigen::Vector2i(u, v);
      }
    }
    if (best_px) seeds_px.push_back(*best_px);
  }
  return seeds_px;
}

}  // namespace palpate::perception
