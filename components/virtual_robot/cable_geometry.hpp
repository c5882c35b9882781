// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/fem/stiffness_matrix.hpp"

namespace palpate::virtual_robot {

/// The straight pieces of one cable, from its guide, fixed to the ground, through eyelets on the
/// body to the last one, where it is attached. Unlike robot::Cable each piece has its own tension.
class CableGeometry {
 public:
  /// `eyelets`: at least one.
  CableGeometry(const Eigen::Vector3d& guide_m,
                const std::vector<fem::InterpolationWeights>& eyelets);

  int PieceCount() const { return static_cast<int>(pieces_.size()); }
  fem::NodePairs CoupledPairs() const;
  void BindTo(const fem::StiffnessMatrix& stiffness);

  /// At the node positions `x_m` [3n]; what follows is of them.
  void Evaluate(const Eigen::VectorXd& x_m);
  double Length_m(int piece) const { return pieces_[At(piece)].length_m; }
  double TotalLength_m() const;
  /// Angle by which the cable turns before piece `piece` >= 1, rad.
  double TurningAngle_rad(int piece) const;
  /// Sum over the eyelets of the squared force on each for a tension of 1 N.
  double SquaredEyeletForces() const;
  /// Adds factor * dlength/dx of one piece to `nodal` [3n].
  void AddGradient(int piece, double factor, Eigen::VectorXd& nodal) const;
  /// Adds tension / length (I - u u') of one piece.
  void AddCurvature(int piece, double tension_N, fem::StiffnessMatrix& stiffness) const;

 private:
  struct Piece {
    Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
    std::vector<int> nodes;
    std::vector<double> coefficients;   ///< the piece's vector: offset + sum coefficients x[nodes]
    std::vector<fem::BlockSlot> slots;  ///< of the pairs (k, l), l <= k
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit; 0 where it has no length
    double length_m = 0.0;
  };

  std::vector<Piece> pieces_;
};

}  // namespace palpate::virtual_robot
