// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/cable_elimination.hpp"
#include "components/force_estimation/config.hpp"
#include "components/force_estimation/fitted_directions.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/frame_loop.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Where the markers should come to lie.
struct MarkerTargets {
  Eigen::VectorXd position_m;  ///< [3m]
  Eigen::VectorXd weight;      ///< [3m] 1 / variance, 1/m^2; 0: not seen
  int rows = 0;                ///< with a weight above 0
};

/// A configuration of the model and the forces it balances.
struct ModelState {
  bool valid = false;
  bool balanced = false;       ///< known to be an equilibrium, not only near one
  Eigen::VectorXd x_m;         ///< [3n]
  Eigen::VectorXd lambda_a_N;  ///< [cables]
  Eigen::VectorXd lambda_f_N;  ///< [3 contacts] x, y, z of each
};

struct MarkerFit {
  Status status;         ///< kBudgetReached: sound, nearer, but not converged
  int iterations = 0;    ///< linearisations
  int chord_steps = 0;   ///< steps without one
  int restorations = 0;  ///< static solves for which Newton's steps were given up
  double error = 0.0;    ///< relative, compared with Config::frame_tolerance
  double chi_squared = 0.0;
  Eigen::VectorXd residual_m;                ///< [3m] target - model, 0 where not seen
  Eigen::MatrixXd covariance_N2;             ///< [3k x 3k] from the weights alone
  Eigen::VectorXd modulus_sensitivity_N;     ///< [3k] dlambda_f / dln E
  std::vector<Observability> observability;  ///< [k]
  std::vector<int> unknowns;                 ///< [k] force components that were fitted
};

/// Forces at given sites that bring the model's markers to their targets in the least-squares
/// sense, in equilibrium: the paper's QP (11)-(14), relinearised until nothing changes. Each step
/// moves forces, tensions and configuration at once (Gauss-Newton), in the loop of
/// fem/frame_loop.hpp; where that diverges, the model follows the forces in equilibrium for one
/// step before the loop goes on. A fit's error is the largest of the residual over the size of the
/// forces, the cable length missed over the cable's rest length, and the change of the forces that
/// the next step would make, over the largest contact force or 1 N; and a thousandth of the error
/// of the state at which the tangent was taken, which the optimum and its intervals depend on.
class MarkerFitter final : private fem::FrameProblem {
 public:
  MarkerFitter(robot::RobotModel& model, const Config& config);

  void SetSites(const std::vector<FitSite>& sites);
  int SiteCount() const { return static_cast<int>(sites_.size()); }

  /// Moves `state` (which must be near an equilibrium) to the fit. With at least one site. The
  /// result stays valid until the next call. Where the status is neither kOk nor kBudgetReached,
  /// `state` is a sound one from before. After the first frame nothing is allocated as long as no
  /// restoration is needed.
  const MarkerFit& Fit(const MarkerTargets& targets, const std::vector<robot::CableCommand>& cables,
                       ModelState* state, const fem::TimeBudget& budget = {});

  const MarkerFit& fit() const { return fit_; }  ///< of the last Fit

  /// Where the last converged fit of these sites ended; `valid` is false where there is none.
  const ModelState& last_good() const { return last_good_; }

  /// Weighted residual that would be left if a force at one more site joined in, to first order
  /// about `state`; one value for each of `candidates`, infinite for one that cannot be told from
  /// the sites before. Not ok where the state cannot be linearised.
  Status Screen(const MarkerTargets& targets, const std::vector<robot::CableCommand>& cables,
                const ModelState& state, const std::vector<FitSite>& candidates,
                std::vector<double>* chi_squared);

  /// Weighted residual of the markers at `state` [and `residual_m` itself, 3m].
  double ChiSquared(const MarkerTargets& targets, const ModelState& state,
                    Eigen::VectorXd* residual_m) const;

 private:
  /// What the present Fit works on.
  struct Frame {
    const MarkerTargets* targets = nullptr;
    const std::vector<robot::CableCommand>* cables = nullptr;
    const fem::TimeBudget* budget = nullptr;
    ModelState* state = nullptr;
    bool observability_known = false;
  };

  Status PrepareExactStep() override;
  Status PrepareChordStep() override { return Status::Ok(); }  // Try has solved for it
  Status Try(double length, bool last) override;
  double TrialError() const override { return trial_error_; }
  void AcceptTrial() override;

  Status RunLoop();
  Status FitWithRestorations();
  Status Restore();
  Status StepToEquilibrium(double fraction);
  Status Linearise(const ModelState& state, bool allow_shift);
  Status SolveQp(const MarkerTargets& targets, const std::vector<robot::CableCommand>& cables,
                 const ModelState& state);
  double Error(const ModelState& state) const;
  double BalanceError(const ModelState& state) const;
  double CableError(const ModelState& state) const;
  double LargestChange(const ModelState& state) const;
  void UpdateWeight();
  void UpdateExternalForce(const Eigen::VectorXd& lambda_f_N);
  fem::QpMatrix Information(const MarkerTargets& targets) const;

  Status Conclude();
  Status CheckTensions(const ModelState& state) const;
  void ModulusSensitivity(const MarkerTargets& targets, const ModelState& state);

  robot::RobotModel& model_;
  Config config_;
  robot::Compliance compliance_;
  fem::StaticSolver equilibrium_;  ///< for restorations
  CableElimination elimination_;
  std::vector<FitSite> sites_;
  FittedDirections directions_;
  fem::QpVector qp_start_;
  MarkerFit fit_;
  Frame frame_;
  ModelState start_, trial_, last_good_;
  double trial_error_ = 0.0;
  double linearised_error_ = 0.0;     ///< of the state at which the tangent was taken
  Eigen::VectorXd weight_N_;          ///< [3n] gravity
  Eigen::VectorXd external_force_N_;  ///< [3n]
  Eigen::VectorXd new_lambda_f_, new_lambda_a_;
  Eigen::VectorXd nodal_, gradient_, effector_motion_, cable_motion_;
  Eigen::MatrixXd modulus_column_;  ///< [reduced x 1]
};

}  // namespace palpate::force_estimation
