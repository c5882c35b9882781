// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::fem {

/// A point that moves with the body.
struct BodyPoint {
  InterpolationWeights weights;  ///< nodes in rising order; the weights add up to 1
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();  ///< at rest, robot frame; what was asked for
  double distance_m = 0.0;  ///< to the nearest point of the rest surface; 0 inside the mesh
  int cell = -1;            ///< the cell that holds the point or from which it is extrapolated
};

/// Expresses points by the nodes of a mesh: inside by the shape functions of the cell that holds
/// the point; outside extrapolated in the cell with the nearest centroid, to first order (tet4:
/// barycentric coordinates; tet10: expanded about the nearest point of that cell). Either way the
/// weights reproduce the rest position, and a motion of the nodes that is affine moves the point
/// by it.
class PointLocator {
 public:
  /// Copies what it needs. The mesh needs cells of positive volume (see CheckSolvable).
  explicit PointLocator(const TetMesh& mesh);

  /// `point_m` at rest, robot frame. Where several cells hold it, the one it lies deepest in.
  BodyPoint Embed(const Eigen::Vector3d& point_m) const;

  /// Mean over a ball: how an eyelet of that radius takes part in the motion. 13 points, the
  /// centre and an icosahedron, exact for polynomials of degree 5 (Stroud 1971, rule S3:5-1).
  /// rest_m, distance_m and cell are those of the centre; a radius of 0 is Embed.
  BodyPoint EmbedBall(const Eigen::Vector3d& centre_m, double radius_m) const;

  /// A line through `point_m` along `direction` in the same cell: weights with sum 0, in the order
  /// of the nodes of `cell`, that give the direction of that line in the deformed body.
  InterpolationWeights EmbedDirection(const Eigen::Vector3d& point_m,
                                      const Eigen::Vector3d& direction, int* cell) const;

  /// Where the straight line from `a_m` to `b_m` enters or leaves a cell (of a curved tet10: its
  /// corner tetrahedron), as shares of its length: rising, from 0 to 1.
  std::vector<double> Crossings(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m) const;

  /// Distance to the nearest point of the rest surface; 0 inside the mesh.
  double Distance_m(const Eigen::Vector3d& point_m) const;

  const TetMesh& mesh() const { return mesh_; }
  const BoundarySurface& boundary() const { return boundary_; }
  const geometry::SurfaceIndex& surface() const { return surface_; }

 private:
  /// Coordinates in the cell's corner tetrahedron; also outside it.
  Eigen::Vector4d Barycentric(int cell, const Eigen::Vector3d& point_m) const;
  int HoldingCell(const Eigen::Vector3d& point_m) const;  ///< -1: outside
  int NearestCentroid(const Eigen::Vector3d& point_m) const;
  Eigen::Vector3d ClosestReferencePoint(int cell, const Eigen::Vector3d& point_m) const;
  Eigen::VectorXd ExpandAbout(int cell, const Eigen::Vector3d& xi,
                              const Eigen::Vector3d& point_m) const;
  /// Reference coordinates of the point in the cell that holds it; outside those of the nearest
  /// point of the cell with the nearest centroid.
  Eigen::Vector3d Locate(const Eigen::Vector3d& point_m, int* cell) const;
  InterpolationWeights Weights(const Eigen::Vector3d& point_m, int* cell) const;
  void BuildGrid();
  Eigen::Array3i GridIndex(const Eigen::Vector3d& point_m) const;
  size_t GridCell(const Eigen::Array3i& index) const;

  TetMesh mesh_;
  BoundarySurface boundary_;
  geometry::SurfaceIndex surface_;
  Eigen::Matrix3Xd centroids_m_;               ///< [3 x cells]
  std::vector<Eigen::Matrix3d> to_reference_;  ///< [cells] inverse of the corner edges, 1/m
  Eigen::Vector3d grid_origin_m_;
  Eigen::Vector3d grid_step_m_;
  Eigen::Array3i grid_size_;
  std::vector<std::vector<int>> grid_;  ///< cells whose box meets each grid cell
};

/// Sum of factor-weighted points as one, nodes in rising order.
InterpolationWeights Combine(const std::vector<InterpolationWeights>& parts,
                             const std::vector<double>& factors);

}  // namespace palpate::fem
