// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/body_shape.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "components/palpate/new_robot/flat_faces.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::command {

namespace {

double MedianEdge_m(const fem::TetMesh& mesh) {
  constexpr std::array<std::array<int, 2>, 6> kEdges = {
      {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  std::vector<double> lengths_m;
  lengths_m.reserve(6 * At(mesh.CellCount()));
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (const auto& [a, b] : kEdges) {
      lengths_m.push_back(
          (mesh.nodes_m.col(mesh.cells(a, cell)) - mesh.nodes_m.col(mesh.cells(b, cell))).norm());
    }
  }
  return Median(std::move(lengths_m));
}

double Volume_m3(const Eigen::Matrix<double, 3, 4>& corners_m) {
  return std::abs((corners_m.rightCols<3>().colwise() - corners_m.col(0)).determinant()) / 6.0;
}

/// Centroid and axes of the volume, elements taken as tetrahedra with straight edges.
void FindAxes(BodyShape* shape) {
  const fem::TetMesh& mesh = shape->mesh;
  double volume_m3 = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Matrix<double, 3, 4> corners_m;
    for (int k = 0; k < 4; ++k) corners_m.col(k) = mesh.nodes_m.col(mesh.cells(k, cell));
    const double v = Volume_m3(corners_m);
    const Eigen::Vector3d sum_m = corners_m.rowwise().sum();
    volume_m3 += v;
    first += v / 4.0 * sum_m;
    // Integral of x x' over a tetrahedron.
    second += v / 20.0 * (corners_m * corners_m.transpose() + sum_m * sum_m.transpose());
  }
  shape->centroid_m = first / volume_m3;
  const Eigen::Matrix3d covariance =
      second / volume_m3 - shape->centroid_m * shape->centroid_m.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  shape->axes = solver.eigenvectors().rowwise().reverse();
  const Eigen::Matrix3Xd along_m =
      shape->axes.transpose() * mesh.nodes_m(Eigen::all, mesh.cells.topRows<4>().reshaped());
  shape->extents_m = along_m.rowwise().maxCoeff() - along_m.rowwise().minCoeff();
}

}  // namespace

BodyShape MeasureShape(const fem::TetMesh& mesh) {
  BodyShape shape;
  shape.mesh = fem::MakeQuadratic(mesh);
  shape.used.assign(At(shape.mesh.NodeCount()), false);
  for (const int node : shape.mesh.cells.reshaped()) shape.used[At(node)] = true;
  shape.boundary = fem::ExtractBoundary(shape.mesh);
  shape.surface = fem::RestSurface(shape.mesh, shape.boundary);
  shape.outer_faces = fem::OuterFaces(shape.mesh, shape.boundary);
  shape.box = geometry::BoundingBox(shape.mesh.nodes_m(Eigen::all, shape.mesh.cells.reshaped()));
  shape.diagonal_m = shape.box.Diagonal_m();
  shape.element_m = MedianEdge_m(shape.mesh);
  FindAxes(&shape);
  shape.flat_faces = FindFlatFaces(shape);
  return shape;
}

}  // namespace palpate::command
