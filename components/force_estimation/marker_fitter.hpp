// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/cable_elimination.hpp"
#include "components/force_estimation/config.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/fem/surface_patch.hpp"
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

/// A place where a force is fitted.
struct FitSite {
  fem::SurfacePatch patch;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit; zero: any
};

/// Which part of a contact's force the markers determine.
enum class Observability {
  kFull,    ///< all that was asked for
  kNormal,  ///< some directions are uncertain, but not the surface normal; those are left at zero
  kNone,    ///< the normal direction, or the given one, is uncertain
};

struct MarkerFit {
  Status status;
  int iterations = 0;
  double chi_squared = 0.0;
  Eigen::VectorXd residual_m;                ///< [3m] target - model, 0 where not seen
  Eigen::MatrixXd covariance_N2;             ///< [3k x 3k] from the weights alone
  Eigen::VectorXd modulus_sensitivity_N;     ///< [3k] dlambda_f / dln E
  std::vector<Observability> observability;  ///< [k]
  std::vector<int> unknowns;                 ///< [k] force components that were fitted
};

/// Forces at given sites that bring the model's markers to their targets in the least-squares
/// sense, in equilibrium: the paper's QP (11)-(14), relinearised until nothing changes.
class MarkerFitter {
 public:
  MarkerFitter(robot::RobotModel& model, const Config& config);

  void SetSites(const std::vector<FitSite>& sites);
  int SiteCount() const { return static_cast<int>(sites_.size()); }

  /// Moves `state` (which must be near an equilibrium) to the fit. With at least one site. The
  /// result stays valid until the next call.
  const MarkerFit& Fit(const MarkerTargets& targets, const std::vector<robot::CableCommand>& cables,
                       ModelState* state);

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
  Status Linearise(const ModelState& state);
  Status SolveQp(const MarkerTargets& targets, const std::vector<robot::CableCommand>& cables,
                 const ModelState& state);
  void AskForEverything();
  void KeepObservable(const MarkerTargets& targets);
  void KeepNormal(size_t site, const Eigen::Matrix3d& covariance_N2);
  void BuildBasis();
  bool Step(const MarkerTargets& targets, const std::vector<robot::CableCommand>& cables,
            ModelState* state);
  bool StepByLinearResponse(ModelState* state);
  bool StepToEquilibrium(const MarkerTargets& targets,
                         const std::vector<robot::CableCommand>& cables, double fraction,
                         ModelState* state);
  double ForceScale(const ModelState& state) const;
  double LargestChange(const ModelState& state) const;
  bool Balanced(const ModelState& state) const;
  Status CheckTensions(const ModelState& state) const;
  void Conclude(const MarkerTargets& targets, const ModelState& state);
  void ModulusSensitivity(const MarkerTargets& targets, const ModelState& state);
  void UpdateExternalForce(const Eigen::VectorXd& lambda_f_N);
  fem::QpMatrix Information(const MarkerTargets& targets) const;

  robot::RobotModel& model_;
  Config config_;
  robot::Compliance compliance_;
  fem::StaticSolver equilibrium_;  ///< for steps too long for the linear response
  CableElimination elimination_;
  std::vector<FitSite> sites_;
  std::vector<Eigen::Matrix3d> directions_;  ///< [k] the first unknowns[k] columns are fitted
  fem::QpMatrix basis_;                      ///< [3k x q] lambda_f = basis q
  fem::QpVector qp_start_;
  MarkerFit fit_;
  Eigen::VectorXd weight_N_;          ///< [3n] gravity
  Eigen::VectorXd external_force_N_;  ///< [3n]
  Eigen::VectorXd new_lambda_f_, new_lambda_a_;
  Eigen::VectorXd trial_x_;
  Eigen::VectorXd nodal_, effector_motion_, cable_motion_;
  Eigen::MatrixXd modulus_column_;  ///< [reduced x 1]
};

}  // namespace palpate::force_estimation
