// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/robot/cable_friction.hpp"

namespace palpate::robot {

/// Pieces shorter than this have no direction; they neither pull nor stiffen nor turn the cable.
inline constexpr double kShortestPiece_m = 1e-9;

/// Angle between two unit vectors, rad, in [0, pi]; accurate for small ones too.
double TurningAngle(const Eigen::Vector3d& before, const Eigen::Vector3d& after);

/// A cable's path at one state and its first derivatives with respect to the points of the path:
/// point 0 the pull point, then the eyelets; piece j runs from point j to point j + 1.
/// Along a straight path the turning angle has no derivative; 0 is taken.
class CablePath {
 public:
  /// `points_m` [3 x points].
  void Evaluate(const Eigen::Matrix3Xd& points_m, const CableFriction& friction);

  Eigen::Index PieceCount() const { return direction_.cols(); }
  /// [3 x points] derivative of the length with respect to the points.
  const Eigen::Matrix3Xd& length_gradient() const { return length_gradient_; }
  /// [3 x points] force on each point for a tension of 1 N at the actuator.
  const Eigen::Matrix3Xd& force() const { return force_; }

  /// Derivative of the length, and of `force`, along a motion of the points [3 x points].
  double LengthAlong(const Eigen::Matrix3Xd& motion_m) const;
  void ForceAlong(const Eigen::Matrix3Xd& motion_m, Eigen::Matrix3Xd* force) const;
  /// [3 x pieces] unit, or 0 where a piece is too short to have one.
  const Eigen::Matrix3Xd& direction() const { return direction_; }
  /// Derivative of `force` with respect to the friction coefficient.
  void ForceAlongFriction(Eigen::Matrix3Xd* force) const;
  /// The same with respect to what it has of friction at one eyelet (CableFriction::Signed).
  void ForceAlongFrictionAt(Eigen::Index eyelet, Eigen::Matrix3Xd* force) const;

  /// What a turn of the cable (between two pieces) adds to dforce/dpoints besides the symmetric
  /// part: dforce = `force` (`angle` . motion), both [3 x points].
  int TurnCount() const { return static_cast<int>(turns_.size()); }
  void Turn(int turn, Eigen::Matrix3Xd* force, Eigen::Matrix3Xd* angle) const;

 private:
  struct TurnData {
    Eigen::Index before = 0;  ///< pieces
    Eigen::Index after = 0;
    double angle = 0.0;
    double sliding = 1.0;                                 ///< CableFriction::Sliding there
    Eigen::Vector3d by_before = Eigen::Vector3d::Zero();  ///< dangle / dvector of the piece, 1/m
    Eigen::Vector3d by_after = Eigen::Vector3d::Zero();
  };

  void FindTurns(const CableFriction& friction);
  double AngleAlong(const TurnData& turn, const Eigen::Matrix3Xd& motion_m) const;
  Eigen::Vector3d PieceAlong(Eigen::Index piece, const Eigen::Matrix3Xd& motion_m) const;
  void AddPieceForce(Eigen::Index piece, const Eigen::Vector3d& pull,
                     Eigen::Matrix3Xd* force) const;

  double friction_ = 0.0;           ///< coefficient
  Eigen::Matrix3Xd direction_;      ///< [3 x pieces] unit, or 0
  Eigen::VectorXd inverse_length_;  ///< [pieces] 1/m, or 0
  Eigen::VectorXd turned_;          ///< [pieces] rad from the actuator on, each turn times its s
  Eigen::VectorXd fraction_;        ///< [pieces] of the actuator's tension
  Eigen::Matrix3Xd length_gradient_;
  Eigen::Matrix3Xd force_;
  std::vector<TurnData> turns_;
};

}  // namespace palpate::robot
