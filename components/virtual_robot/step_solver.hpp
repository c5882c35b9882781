// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/virtual_robot/cable_system.hpp"
#include "components/virtual_robot/chamber_system.hpp"
#include "components/virtual_robot/contact.hpp"
#include "components/virtual_robot/contact_surface.hpp"
#include "components/virtual_robot/time_scheme.hpp"
#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/core/status.hpp"
#include "libs/core/thread_team.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/node_matrix.hpp"
#include "libs/fem/sparse/sparse_solver.hpp"
#include "libs/fem/stiffness_matrix.hpp"
#include "libs/fem/viscosity.hpp"

namespace palpate::virtual_robot {

/// Everything that acts on the nodes, whoever owns it.
struct Forces {
  fem::ElasticBody& elastic;
  fem::NodeMatrix& mass;
  fem::Viscosity& viscosity;
  CableSystem& cables;
  ChamberSystem& chambers;
  const ContactSurface& surface;
  std::vector<Contact>& contacts;
  double mass_damping_1_s = 0.0;
};

/// One step to be solved for. Cables, contacts and viscosity are set for it already.
struct StepTask {
  TimeScheme scheme;
  Eigen::VectorXd load_N;   ///< [3n] dead loads at the instant of balance
  Eigen::VectorXd start_m;  ///< [3n] first guess; clamped nodes are where they shall be
};

/// Newton's method for the balance of one time step,
///   M a + scale F_elastic(x_a) + L x_a + alpha M v = load + contacts(x_1) + cables(x_1),
/// x_a, v and a at the intermediate instant of the scheme. Elastic forces of the midpoint rule are
/// corrected along M dx so that their work is the change of the elastic energy (O. Gonzalez, Exact
/// energy and momentum conserving algorithms for general models in nonlinear elasticity, Comput.
/// Methods Appl. Mech. Eng. 190, 2000). Contacts and cables, as they are at the end of the step,
/// take energy away where they are hit, and never give any.
///
/// The factor of the tangent is kept from step to step as long as corrections shrink fast and much
/// the same points touch. Cable tensions follow from the compliance of the pieces
/// (cable_system.hpp).
class StepSolver {
 public:
  static constexpr double kTolerance_m = 3e-8;  ///< of the positions, largest error of a node
  static constexpr double kConservingTolerance_m = 1e-10;  ///< where energy is conserved
  static constexpr double kLargestChange = 0.3;            ///< of the contacts' stiffness
  static constexpr int kMostCorrections = 40;
  static constexpr double kLargestCorrection_m = 1.0;

  StepSolver(const Forces& forces, const fem::FixedDirections& fixed, int threads);

  /// Where tools that touch turn back, start or stop, the body goes with them, and not on as
  /// before: adds to `start_m` what the factor says of that. `share`: length of the step over that
  /// of the one before. Without inertia, and where the factor knows what touches; else it does
  /// nothing.
  void FollowTools(const StepTask& task, const MotionState& from, double share,
                   Eigen::VectorXd* start_m);

  /// Finds `to` from `from`. On failure `to` and the tensions are not to be used.
  Status Solve(const StepTask& task, const MotionState& from, MotionState* to);

  /// [3n] What the balance leaves over; in clamped nodes the force of the body on the clamp.
  const Eigen::VectorXd& residual_N() const { return nodal_; }
  const StepCost& cost() const { return cost_; }  ///< since the beginning

 private:
  /// Balance at positions x_1; `with_tangent`: its derivative too, factorised.
  Status Balance(const StepTask& task, const MotionState& from, MotionState* to, bool with_tangent);
  Status BalanceAlong(const StepTask& task, const MotionState& from, MotionState* to);
  double GoAsFarAsContactsLet(MotionState* to);
  double ContactWork() const;
  void SetRates(const StepTask& task, const MotionState& from, MotionState* to) const;
  void Finish(const StepTask& task, const MotionState& from, MotionState* to);
  void AddInertia(const StepTask& task, const MotionState& from, MotionState* to);
  void AddEnergyCorrection(const MotionState& from, const MotionState& to);
  Status Factorise(const StepTask& task, const Eigen::VectorXd& x_m);
  Status FactoriseShifted();
  /// Newton's correction of positions and tensions; false where the cables' laws are not met.
  bool Correct();
  /// Applies a share of the correction.
  void Move(double share, MotionState* to) const;
  /// Whether the tangent knows too little of what touches now.
  bool ContactsChanged() const;
  bool Fits(const TimeScheme& scheme) const;

  Forces forces_;
  fem::StiffnessMatrix matrix_;
  std::shared_ptr<ThreadTeam> team_;
  std::unique_ptr<fem::SparseSolver> solver_;
  std::vector<int> clamped_;
  TimeScheme factor_scheme_;
  double factor_scale_ = 0.0;
  bool has_factor_ = false;
  bool shifted_ = false;
  double energy_before_J_ = 0.0;
  double work_in_hand_ = 0.0;  ///< of what is left over, along the correction
  double share_ = 1.0;         ///< of the last correction, that was applied

  Eigen::VectorXd nodal_;
  Eigen::VectorXd intermediate_m_;
  Eigen::VectorXd acceleration_m_s2_;
  Eigen::MatrixXd correction_;  ///< [Size() x 1]
  Eigen::MatrixXd gradients_;   ///< [3n x pieces] of the cables' lengths
  Eigen::MatrixXd columns_;     ///< [Size() x pieces] of their forces, solved for
  Eigen::MatrixXd reduced_;     ///< [Size() x pieces] of their gradients
  Eigen::MatrixXd compliance_m_N_;
  StepCost cost_;
};

}  // namespace palpate::virtual_robot
