// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/fem/scalar_constraint.hpp"
#include "libs/fem/stiffness_matrix.hpp"

namespace palpate::fem {

/// A closed surface that moves with the body. Points lie on the body; faces are triangles of
/// points.
struct MovingSurface {
  std::vector<InterpolationWeights> points;
  /// [3 or 6 x f] indices of points: corners counter-clockwise seen from outside of the volume,
  /// then, for curved faces, the points on the edges 01, 12, 20.
  Eigen::MatrixXi faces;
};

/// Volume inside a closed surface that moves with the body, and its exact derivatives. By the
/// divergence theorem V = 1/3 sum over faces of the integral of x . (x_xi x x_eta), which is
/// trilinear in the points: V = sum t_abc det(x_a, x_b, x_c), with constants t_abc of the face. A
/// pressure p inside loads the body with p dV/dx, a follower load whose tangent -p d2V/dx2 is
/// symmetric because the surface is closed. Curved faces are integrated exactly.
/// Whether the surface is closed is up to the caller. One call at a time: sums are kept in it.
class EnclosedVolume {
 public:
  explicit EnclosedVolume(MovingSurface surface);

  const MovingSurface& surface() const { return surface_; }
  double Volume_m3(const Eigen::VectorXd& x_m) const;
  /// Adds factor * dV/dx [3n].
  void AddGradient(const Eigen::VectorXd& x_m, double factor, Eigen::VectorXd& nodal) const;
  /// Nodes that d2V/dx2 couples.
  NodePairs CoupledPairs() const;
  /// Looks up its blocks once; AddCurvature needs it.
  void BindTo(const StiffnessMatrix& stiffness);
  /// Adds factor * d2V/dx2.
  void AddCurvature(const Eigen::VectorXd& x_m, double factor, StiffnessMatrix& stiffness) const;

 private:
  /// Local points a < b < c of a face, and t_abc.
  struct Term {
    int a = 0, b = 0, c = 0;
    double t = 0.0;
  };
  /// Where a pair of points couples a pair of nodes.
  struct Coupling {
    int pair = 0;
    double weight = 0.0;  ///< product of both interpolation weights
    int node_a = 0, node_b = 0;
    BlockSlot slot;
  };

  static std::vector<Term> TermsOf(Eigen::Index points_per_face);
  void FindPairs();
  void FindCouplings();
  void Place(const Eigen::VectorXd& x_m) const;

  MovingSurface surface_;
  std::vector<Term> terms_;
  std::vector<Eigen::Vector2i> pairs_;  ///< of points, rising
  /// [local pairs x faces] index of the pair times two, plus one where the face names it the other
  /// way round.
  Eigen::MatrixXi pair_of_face_;
  std::vector<Coupling> couplings_;
  mutable Eigen::Matrix3Xd points_m_;  ///< relative to the first point
  mutable Eigen::Matrix3Xd per_point_m2_;
  mutable Eigen::Matrix3Xd per_pair_m_;
};

}  // namespace palpate::fem
