// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/virtual_robot/bench_body.hpp"
#include "components/virtual_robot/cable_geometry.hpp"
#include "components/virtual_robot/effects.hpp"

namespace palpate::virtual_robot {

/// The cables between actuators and body, with cable_routing (the guide is elsewhere),
/// cable_elasticity, cable_cutting and cable_friction. A cable pulls or is slack, and never pulls
/// harder than its largest tension: then it slips at the actuator.
///
/// Friction: at each eyelet that the cable runs through, T_out = T_in exp(-mu theta s), theta the
/// angle by which it turns there. s is 1 while the cable slides towards the actuator, -1 out of it,
/// and follows the sliding in between over a travel of 2 kPresliding_m: it sticks, elastically.
/// Cutting: each eyelet yields to the force of the cable on it; of that the cable's length along
/// its path is kept, not the change of its direction.
class CableSystem {
 public:
  static constexpr double kPresliding_m = 1e-4;

  /// Throws InputError where an effect does not fit.
  CableSystem(const BenchBody& body, const Effects& effects);

  int CableCount() const { return static_cast<int>(cables_.size()); }
  int PieceCount() const { return static_cast<int>(tension_N_.size()); }
  fem::NodePairs CoupledPairs() const;
  void BindTo(const fem::StiffnessMatrix& stiffness);

  /// Slack, and no eyelet has slid yet.
  void Reset();
  /// m that each actuator has taken in [cables], NaN: not driven.
  void SetPulledIn(const Eigen::VectorXd& pulled_in_m) { pulled_in_m_ = pulled_in_m; }
  /// Without friction until the next call: for the way to a new beginning.
  void SetFrictionless(bool frictionless) { frictionless_ = frictionless; }

  /// Lengths and directions at `x_m`; what follows is of them.
  void Evaluate(const Eigen::VectorXd& x_m);
  Eigen::VectorXd Lengths_m() const;  ///< [pieces]
  /// dlength/dx [3n x pieces].
  void Gradients(Eigen::MatrixXd* nodal) const;
  /// Adds factor times the force on the nodes of the present tensions.
  void AddForces(double factor, Eigen::VectorXd& nodal) const;
  void AddCurvature(fem::StiffnessMatrix& stiffness) const;

  /// Finds the tensions where the pieces, were there no tension, would have the lengths
  /// `slack_m` [pieces], and each newton shortens them by `compliance_m_N` [pieces x pieces].
  /// False where they are not found.
  bool SolveTensions(const Eigen::VectorXd& slack_m, const Eigen::MatrixXd& compliance_m_N);
  const Eigen::VectorXd& tension_N() const { return tension_N_; }  ///< [pieces]
  void SetTensions(const Eigen::VectorXd& tension_N) { tension_N_ = tension_N; }
  double DriveTension_N(int cable) const;

  /// The eyelets have slid to where the cables are now.
  void Commit();

 private:
  struct Cable {
    CableGeometry geometry;
    int first_piece = 0;
    double rest_length_m = 0.0;
    double friction = 0.0;
    double compliance_m_N = 0.0;  ///< of the cable itself
    double cutting_m_N = 0.0;
    double max_tension_N = 0.0;
    Eigen::VectorXd sliding;   ///< [pieces] s before each piece; 0 unused
    Eigen::VectorXd beyond_m;  ///< [pieces] length from there on at the last Commit
  };
  /// What the laws of the cables leave over at some tensions, and its derivative by them.
  struct Balance {
    Eigen::VectorXd residual_N;
    Eigen::MatrixXd slope;
  };

  void Balanced(const Eigen::VectorXd& slack_m, const Eigen::MatrixXd& compliance_m_N,
                const Eigen::VectorXd& tension_N, Balance* balance) const;
  void BalanceDrive(size_t cable, const Eigen::VectorXd& length_m,
                    const Eigen::MatrixXd& compliance_m_N, const Eigen::VectorXd& tension_N,
                    Balance* balance) const;
  void BalanceEyelets(size_t cable, const Eigen::VectorXd& length_m,
                      const Eigen::MatrixXd& compliance_m_N, const Eigen::VectorXd& tension_N,
                      Balance* balance) const;
  double Sliding(const Cable& cable, int piece, double beyond_m) const;

  std::vector<Cable> cables_;
  Eigen::VectorXd pulled_in_m_;
  Eigen::VectorXd tension_N_;
  bool frictionless_ = false;
};

}  // namespace palpate::virtual_robot
