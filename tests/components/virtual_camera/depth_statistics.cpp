// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/virtual_camera/depth_statistics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "libs/core/statistics.hpp"

namespace palpate::virtual_camera {

namespace {

constexpr int kPatch_px = 16;
constexpr double kEdge_px = 1.0;
constexpr double kStep_px = 8.0;
constexpr double kFlat_px = 0.35;  // patches whose residuals reach farther are no planes

double MedianOf(std::vector<double> values) { return values.empty() ? 0.0 : UpperMedian(values); }

// Disparities, 0 where nothing is seen.
rgbd::Image<double, 1> DisparitiesOf(const rgbd::RangeImage& range, double focal_baseline_px_m) {
  rgbd::Image<double, 1> disparities(range.width_px, range.height_px);
  for (std::size_t i = 0; i < range.values.size(); ++i) {
    const double z = static_cast<double>(range.values[i]);
    disparities.values[i] = z > 0.0 ? focal_baseline_px_m / z : 0.0;
  }
  return disparities;
}

// A plane in space is one in disparity too. Residuals of the patch; empty: no flat, whole patch.
Eigen::MatrixXd ResidualsOf(const rgbd::Image<double, 1>& disparities, int u0, int v0) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> design(kPatch_px * kPatch_px, 3);
  Eigen::VectorXd d(kPatch_px * kPatch_px);
  for (int v = 0; v < kPatch_px; ++v) {
    for (int u = 0; u < kPatch_px; ++u) {
      const int i = v * kPatch_px + u;
      d[i] = *disparities.Pixel(u0 + u, v0 + v);
      if (d[i] == 0.0) return {};
      design.row(i) << u - 7.5, v - 7.5, 1.0;
    }
  }
  const Eigen::Vector3d plane =
      Eigen::LDLT<Eigen::Matrix3d>(design.transpose() * design).solve(design.transpose() * d);
  const Eigen::VectorXd residuals = d - design * plane;
  if (residuals.cwiseAbs().maxCoeff() > kFlat_px) return {};
  return residuals.reshaped(kPatch_px, kPatch_px);
}

void MeasurePlanes(const rgbd::Image<double, 1>& disparities, DepthStatistics* result) {
  std::vector<double> sigmas;
  std::array<double, 5> products = {};
  for (int v = 0; v + kPatch_px <= disparities.height_px; v += kPatch_px) {
    for (int u = 0; u + kPatch_px <= disparities.width_px; u += kPatch_px) {
      const Eigen::MatrixXd r = ResidualsOf(disparities, u, v);
      if (r.size() == 0) continue;
      sigmas.push_back(std::sqrt(r.squaredNorm() / (kPatch_px * kPatch_px - 3)));
      for (int lag = 0; lag < 5; ++lag) {
        const int rest = kPatch_px - lag;
        const double down = r.topRows(rest).cwiseProduct(r.bottomRows(rest)).mean();
        const double across = r.leftCols(rest).cwiseProduct(r.rightCols(rest)).mean();
        products[static_cast<std::size_t>(lag)] += 0.5 * (down + across);
      }
    }
  }
  result->patches = static_cast<int>(sigmas.size());
  result->plane_sigma_px = MedianOf(sigmas);
  for (std::size_t lag = 0; lag < 5; ++lag) result->correlation[lag] = products[lag] / products[0];
}

struct Hole {
  int pixels = 0;
  bool at_border = false;
  double nearest_px = 0.0;  // disparities around it
  double farthest_px = 1e9;
};

// The hole that (u0, v0) belongs to, which is marked as seen.
Hole Fill(const rgbd::Image<double, 1>& disparities, int u0, int v0,
          rgbd::Image<std::uint8_t, 1>* seen) {
  Hole hole;
  std::vector<std::array<int, 2>> open = {{u0, v0}};
  *seen->Pixel(u0, v0) = 1;
  while (!open.empty()) {
    const auto [u, v] = open.back();
    open.pop_back();
    ++hole.pixels;
    for (const auto& [du, dv] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int x = u + du;
      const int y = v + dv;
      if (x < 0 || y < 0 || x >= disparities.width_px || y >= disparities.height_px) {
        hole.at_border = true;
        continue;
      }
      const double d = *disparities.Pixel(x, y);
      if (d > 0.0) {
        hole.nearest_px = std::max(hole.nearest_px, d);
        hole.farthest_px = std::min(hole.farthest_px, d);
      } else if (*seen->Pixel(x, y) == 0) {
        *seen->Pixel(x, y) = 1;
        open.push_back({x, y});
      }
    }
  }
  return hole;
}

void MeasureHoles(const rgbd::Image<double, 1>& disparities, DepthStatistics* result) {
  rgbd::Image<std::uint8_t, 1> seen(disparities.width_px, disparities.height_px);
  const double all = static_cast<double>(disparities.values.size());
  int pixels = 0;
  int at_edges = 0;
  int small = 0;
  for (int v = 0; v < disparities.height_px; ++v) {
    for (int u = 0; u < disparities.width_px; ++u) {
      if (*disparities.Pixel(u, v) > 0.0 || *seen.Pixel(u, v) != 0) continue;
      const Hole hole = Fill(disparities, u, v, &seen);
      if (hole.at_border || hole.pixels > 0.05 * all) continue;
      ++result->holes;
      pixels += hole.pixels;
      small += hole.pixels <= 2 ? 1 : 0;
      if (hole.nearest_px - hole.farthest_px > kEdge_px) at_edges += hole.pixels;
    }
  }
  result->hole_pixels = pixels / all;
  result->at_edges = at_edges / std::max(1.0, static_cast<double>(pixels));
  result->single = small / std::max(1.0, static_cast<double>(result->holes));
}

void MeasureShadows(const rgbd::Image<double, 1>& disparities, DepthStatistics* result) {
  std::vector<double> up;
  std::vector<double> down;
  for (int v = 0; v < disparities.height_px; ++v) {
    int last = -1;  // column of the last pixel that is seen
    for (int u = 0; u < disparities.width_px; ++u) {
      if (*disparities.Pixel(u, v) == 0.0) continue;
      if (last >= 0) {
        const double step = *disparities.Pixel(u, v) - *disparities.Pixel(last, v);
        const double share = (u - last - 1) / std::abs(step);
        if (std::abs(step) >= kStep_px) (step > 0.0 ? up : down).push_back(share);
      }
      last = u;
    }
  }
  result->steps = static_cast<int>(up.size() + down.size());
  result->shadow_width = MedianOf(up) + MedianOf(down);
}

}  // namespace

DepthStatistics StatisticsOf(const rgbd::RangeImage& range, double focal_baseline_px_m) {
  const rgbd::Image<double, 1> disparities = DisparitiesOf(range, focal_baseline_px_m);
  DepthStatistics result;
  const auto valid = std::count_if(disparities.values.begin(), disparities.values.end(),
                                   [](double d) { return d > 0.0; });
  result.valid = static_cast<double>(valid) / static_cast<double>(disparities.values.size());
  MeasurePlanes(disparities, &result);
  MeasureHoles(disparities, &result);
  MeasureShadows(disparities, &result);
  return result;
}

}  // namespace palpate::virtual_camera
