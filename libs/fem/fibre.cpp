// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/fibre.hpp"

#include <array>
#include <cmath>

#include "libs/core/check.hpp"

namespace palpate::fem {

namespace {

/// A piece of a tet10 that is longer than this share of its cell has two points: the strain varies
/// along it. One point leaves out (share)^2 / 12 of that variation.
constexpr double kLongPiece = 0.3;

constexpr std::array<double, 2> kGauss{0.5 - 0.28867513459481287, 0.5 + 0.28867513459481287};

double CellSize_m(const TetMesh& mesh, int cell) {
  Eigen::Matrix3d edges_m;
  for (int k = 0; k < 3; ++k) {
    edges_m.col(k) =
        mesh.nodes_m.col(mesh.cells(k + 1, cell)) - mesh.nodes_m.col(mesh.cells(0, cell));
  }
  return std::cbrt(std::abs(edges_m.determinant()));
}

/// Adds the straight piece from `a_m` to `b_m`, which lies in one cell.
void AddPiece(const PointLocator& locator, const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
              EmbeddedFibre* fibre) {
  const Eigen::Vector3d along_m = b_m - a_m;
  const double length_m = along_m.norm();
  const Eigen::Vector3d direction = along_m / length_m;
  const Eigen::Vector3d middle_m = 0.5 * (a_m + b_m);
  const double off_m = locator.Distance_m(middle_m);
  if (off_m > fibre->off_m) {
    fibre->off_m = off_m;
    fibre->off_at_m = middle_m;
  }
  FibrePoint point;
  point.direction = locator.EmbedDirection(middle_m, direction, &point.cell);
  const TetMesh& mesh = locator.mesh();
  const bool varies = mesh.element_type() == ElementType::kTet10 &&
                      length_m > kLongPiece * CellSize_m(mesh, point.cell);
  if (!varies) {
    point.length_m = length_m;
    fibre->points.push_back(std::move(point));
    return;
  }
  for (const double place : kGauss) {
    point.direction = locator.EmbedDirection(a_m + place * along_m, direction, &point.cell);
    point.length_m = 0.5 * length_m;
    fibre->points.push_back(point);
  }
}

}  // namespace

void AddPolyline(const PointLocator& locator, const Eigen::Matrix3Xd& path_m,
                 EmbeddedFibre* fibre) {
  PALPATE_CHECK(path_m.cols() >= 2, path_m.cols());
  for (Eigen::Index k = 1; k < path_m.cols(); ++k) {
    const Eigen::Vector3d from_m = path_m.col(k - 1);
    const Eigen::Vector3d along_m = path_m.col(k) - from_m;
    PALPATE_CHECK(along_m.norm() > 0.0, k);
    const std::vector<double> cuts = locator.Crossings(from_m, path_m.col(k));
    for (size_t c = 1; c < cuts.size(); ++c) {
      AddPiece(locator, from_m + cuts[c - 1] * along_m, from_m + cuts[c] * along_m, fibre);
    }
  }
}

}  // namespace palpate::fem
