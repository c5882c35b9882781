// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "libs/fem/boundary_surface.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

/// A cube of 10 x 10 x 10 bricks of 1 m with only the elements whose centroid is kept.
TetMesh Cube(const std::function<bool(const Eigen::Vector3d&)>& keep) {
  TetMesh mesh = BoxMesh(Eigen::Vector3d::Constant(10.0), Eigen::Vector3i::Constant(10));
  std::vector<int> kept;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Vector3d centroid_m = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) centroid_m += 0.25 * mesh.nodes_m.col(mesh.cells(k, cell));
    if (keep(centroid_m)) kept.push_back(cell);
  }
  mesh.cells = mesh.cells(Eigen::all, kept).eval();
  return mesh;
}

/// Distance from the cube's centre along the farthest axis.
double Reach_m(const Eigen::Vector3d& point_m) { return (point_m.array() - 5.0).abs().maxCoeff(); }

double LeastReach_m(const TetMesh& mesh, const BoundarySurface& boundary,
                    const std::vector<int>& faces) {
  double least_m = 10.0;
  for (const int face : faces) {
    for (int k = 0; k < 3; ++k) {
      least_m = std::min(least_m, Reach_m(mesh.nodes_m.col(boundary.faces(k, face))));
    }
  }
  return least_m;
}

TEST(OuterFaces, AreAllOfASolidBody) {
  const TetMesh mesh = Cube([](const auto&) { return true; });
  const BoundarySurface boundary = ExtractBoundary(mesh);
  EXPECT_EQ(std::ssize(OuterFaces(mesh, boundary)), boundary.FaceCount());
}

TEST(OuterFaces, LeaveOutTheWallsOfAClosedCavity) {
  const TetMesh mesh = Cube([](const auto& at_m) { return Reach_m(at_m) > 3.0; });
  const BoundarySurface boundary = ExtractBoundary(mesh);
  const auto outer = OuterFaces(mesh, boundary);
  EXPECT_EQ(std::ssize(outer), 6 * 100 * 2);
  EXPECT_EQ(boundary.FaceCount(), 6 * 100 * 2 + 6 * 36 * 2);
  EXPECT_EQ(LeastReach_m(mesh, boundary, outer), 5.0);
}

TEST(OuterFaces, LeaveOutWhatLiesInACavity) {
  const TetMesh mesh =
      Cube([](const auto& at_m) { return Reach_m(at_m) > 3.0 || Reach_m(at_m) < 1.0; });
  const BoundarySurface boundary = ExtractBoundary(mesh);
  const auto outer = OuterFaces(mesh, boundary);
  EXPECT_EQ(std::ssize(outer), 6 * 100 * 2);
  EXPECT_EQ(LeastReach_m(mesh, boundary, outer), 5.0);
}

TEST(OuterFaces, HoldTheWallsOfACavityThatIsOpen) {
  const TetMesh mesh = Cube([](const auto& at_m) {
    const bool hole = std::abs(at_m.x() - 5.0) < 1.0 && std::abs(at_m.y() - 5.0) < 1.0;
    return Reach_m(at_m) > 3.0 && !(hole && at_m.z() > 5.0);
  });
  const BoundarySurface boundary = ExtractBoundary(mesh);
  EXPECT_EQ(std::ssize(OuterFaces(mesh, boundary)), boundary.FaceCount());
}

TEST(OuterFaces, HoldEveryPieceOfABodyInPieces) {
  const TetMesh mesh = Cube([](const auto& at_m) { return std::abs(at_m.x() - 5.0) > 1.0; });
  const BoundarySurface boundary = ExtractBoundary(mesh);
  EXPECT_EQ(std::ssize(OuterFaces(mesh, boundary)), boundary.FaceCount());
}

}  // namespace
}  // namespace palpate::fem
