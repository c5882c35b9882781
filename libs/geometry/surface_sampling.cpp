// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/surface_sampling.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::geometry {

namespace {

constexpr int kDenseSamplesAtLeast = 2000;
constexpr int kDenseSamplesPerPoint = 40;
/// 1/g and 1/g^2 for the root g of g^3 = g + 1 (Roberts 2018, "The unreasonable effectiveness of
/// quasirandom sequences").
constexpr double kR2First = 0.7548776662466927;
constexpr double kR2Second = 0.5698402909980532;

double Fraction(double value) { return value - std::floor(value); }

std::vector<double> CumulativeAreas_m2(const TriangleSurface& surface) {
  std::vector<double> cumulative_m2;
  cumulative_m2.reserve(static_cast<size_t>(surface.TriangleCount()));
  double area_m2 = 0.0;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    area_m2 += TriangleAreaVector_m2(surface, t).norm();
    cumulative_m2.push_back(area_m2);
  }
  return cumulative_m2;
}

/// The i-th point of the R2 sequence, folded from the unit square into the triangle.
Eigen::Vector3d PointInTriangle(const TriangleSurface& surface, int triangle, int i) {
  double u = Fraction(0.5 + kR2First * i);
  double v = Fraction(0.5 + kR2Second * i);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return (1.0 - u - v) * surface.Corner(triangle, 0) + u * surface.Corner(triangle, 1) +
         v * surface.Corner(triangle, 2);
}

}  // namespace

SurfaceSamples SampleByArea(const TriangleSurface& surface, int count) {
  PALPATE_CHECK(count >= 1, count);
  const std::vector<double> cumulative_m2 = CumulativeAreas_m2(surface);
  PALPATE_CHECK(!cumulative_m2.empty() && cumulative_m2.back() > 0.0, cumulative_m2.size());
  SurfaceSamples samples{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count), {}};
  samples.triangles.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double mark_m2 = cumulative_m2.back() * (i + 0.5) / count;
    const auto holder = std::upper_bound(cumulative_m2.begin(), cumulative_m2.end() - 1, mark_m2);
    const int triangle = static_cast<int>(holder - cumulative_m2.begin());
    samples.positions_m.col(i) = PointInTriangle(surface, triangle, i);
    samples.normals.col(i) = TriangleNormal(surface, triangle);
    samples.triangles.push_back(triangle);
  }
  return samples;
}

std::vector<int> FarthestPoints(const Eigen::Ref<const Eigen::Matrix3Xd>& points_m, int count) {
  PALPATE_CHECK(count >= 1 && count <= points_m.cols(), count, points_m.cols());
  const auto squared_distances_m2 = [&](const Eigen::Vector3d& point_m) -> Eigen::VectorXd {
    return (points_m.colwise() - point_m).colwise().squaredNorm().transpose();
  };
  Eigen::Index farthest = 0;
  squared_distances_m2(points_m.rowwise().mean()).maxCoeff(&farthest);
  std::vector<int> chosen{static_cast<int>(farthest)};
  Eigen::VectorXd to_chosen_m2 = squared_distances_m2(points_m.col(farthest));
  while (static_cast<int>(chosen.size()) < count) {
    to_chosen_m2.maxCoeff(&farthest);
    chosen.push_back(static_cast<int>(farthest));
    to_chosen_m2 = to_chosen_m2.cwiseMin(squared_distances_m2(points_m.col(farthest)));
  }
  return chosen;
}

SurfaceSamples SpreadEvenly(const TriangleSurface& surface, int count) {
  const SurfaceSamples dense =
      SampleByArea(surface, std::max(kDenseSamplesAtLeast, kDenseSamplesPerPoint * count));
  SurfaceSamples spread{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count), {}};
  for (const int i : FarthestPoints(dense.positions_m, count)) {
    const Eigen::Index column = spread.Count();
    spread.positions_m.col(column) = dense.positions_m.col(i);
    spread.normals.col(column) = dense.normals.col(i);
    spread.triangles.push_back(dense.triangles[At(i)]);
  }
  return spread;
}

}  // namespace palpate::geometry
