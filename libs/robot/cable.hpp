// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/actuator.hpp"
#include "libs/robot/cable_friction.hpp"

namespace palpate::robot {

/// A cable: from a pull point fixed to the ground through eyelets on the body, in which it slides,
/// to the last one, where it is attached. Its value is its length outside the actuator, m; its
/// multiplier the tension at the actuator, N: without friction the same all along. A cable cannot
/// push.
class Cable final : public Actuator {
 public:
  /// `eyelets`: at least one, weights as in fem/interpolation_weights.hpp; `rest_x_m` [3n] rest
  /// positions.
  Cable(const Eigen::Vector3d& pull_point_m, std::vector<fem::InterpolationWeights> eyelets,
        const Eigen::VectorXd& rest_x_m);

  double rest_length_m() const { return rest_value_m(); }
  const Eigen::Vector3d& pull_point_m() const { return pull_point_m_; }
  /// `rest_x_m` as at the construction.
  void SetPullPoint(const Eigen::Vector3d& pull_point_m, const Eigen::VectorXd& rest_x_m);
  const std::vector<fem::InterpolationWeights>& eyelets() const { return eyelets_; }
  /// The same nodes as before, with other weights: what BindTo found stays.
  void SetEyelet(int eyelet, const std::vector<double>& weights, const Eigen::VectorXd& rest_x_m);
  const CableFriction& friction() const { return friction_; }
  void SetFriction(const CableFriction& friction);
  /// [3 x eyelets + 1], pull point first.
  Eigen::Matrix3Xd Path_m(const Eigen::VectorXd& x_m) const;
  /// The same into memory that is kept.
  void FindPath(const Eigen::VectorXd& x_m, Eigen::Matrix3Xd* path_m) const;

  double Value(const Eigen::VectorXd& x_m) const override;
  /// The forces of the tension: of dlength/dx, each piece's part times the fraction of the
  /// actuator's tension that reaches it. Without friction the gradient of the length.
  void AddGradient(const Eigen::VectorXd& x_m, double factor,
                   Eigen::VectorXd& nodal) const override;
  fem::NodePairs CoupledPairs() const override;
  void BindTo(const fem::StiffnessMatrix& stiffness) override;
  /// Geometric stiffness lambda / L (I - u u') of each straight piece, lambda its own tension. What
  /// is left out with friction, the change of these tensions with the turning angles, is not
  /// symmetric: Newton's method then converges linearly, the slower the more friction.
  void AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                    fem::StiffnessMatrix& stiffness) const override;

 private:
  /// A straight piece: its vector is offset + sum of coefficients[k] x[nodes[k]].
  struct Piece {
    Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
    std::vector<int> nodes;
    std::vector<double> coefficients;
    std::vector<fem::BlockSlot> slots;  ///< of the pairs (k, l), l <= k

    Eigen::Vector3d Vector(const Eigen::VectorXd& x_m) const;
  };

  Piece MakePiece(size_t eyelet) const;  ///< that ends there

  Eigen::Vector3d pull_point_m_;
  std::vector<fem::InterpolationWeights> eyelets_;
  std::vector<Piece> pieces_;
  CableFriction friction_;
};

}  // namespace palpate::robot
