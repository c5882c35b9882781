// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/fit/actuator_condensation.hpp"
#include "components/force_estimation/fit/anderson_accelerator.hpp"
#include "components/force_estimation/fit/observable_subspace.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/newton_loop.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What the observed rows should come to be: coordinates of markers, or of surface features along
/// their normals.
struct RowTargets {
  Eigen::VectorXd value_m;  ///< [rows]
  Eigen::VectorXd weight;   ///< [rows] 1 / variance, 1/m^2; 0: not seen
  int rows = 0;             ///< with a weight above 0
};

/// A configuration of the model and the forces it balances.
struct ModelState {
  bool valid = false;
  bool balanced = false;       ///< known to be an equilibrium, not only near one
  Eigen::VectorXd x_m;         ///< [3n]
  Eigen::VectorXd lambda_a_N;  ///< [cables]
  Eigen::VectorXd lambda_f_N;  ///< [3 contacts] x, y, z of each
};

struct ForceFit {
  Status status;               ///< kBudgetReached: sound, nearer, but not converged
  int iterations = 0;          ///< linearisations
  int chord_steps = 0;         ///< steps without one
  int continuation_steps = 0;  ///< static solves for which Newton's steps were given up
  double error = 0.0;          ///< relative, compared with Config::frame_tolerance
  double chi_squared = 0.0;
  Eigen::VectorXd residual_m;                ///< [rows] target - model, 0 where not seen
  Eigen::MatrixXd covariance_N2;             ///< [3k x 3k] from weights and priors
  Eigen::VectorXd modulus_sensitivity_N;     ///< [3k] dlambda_f / dln E
  std::vector<Observability> observability;  ///< [k]
  std::vector<int> unknowns;                 ///< [k] force components that were fitted
};

/// What the parts of a fit cost, in substitutions of a single right-hand side.
inline constexpr double kFactorWork = 8.0;
inline constexpr double kColumnsWork = 2.0;  ///< of some twenty right-hand sides at once

/// Forces at given sites that bring what is observed of the model to its targets in the
/// least-squares sense, in equilibrium: the paper's QP (11)-(14), relinearised until nothing
/// changes. Each step moves forces, tensions and configuration at once (Gauss-Newton), in the loop
/// of fem/newton_loop.hpp; where that diverges, the model follows the forces in equilibrium for one
/// step before the loop goes on. A fit's error is the largest of the residual over the size of the
/// forces, the cable length missed over the cable's rest length, and the change of the forces that
/// the next step would make, over the largest contact force or 1 N; and a thousandth of the error
/// of the state at which the tangent was taken, which the optimum and its intervals depend on.
class ForceFitter final : private fem::NewtonProblem {
 public:
  /// With x, y and z of the robot's markers as rows.
  ForceFitter(robot::RobotModel& model, const Config& config);

  /// Other rows; to be called before Fit.
  void SetRows(std::vector<robot::ObservationRow> rows);
  const std::vector<robot::ObservationRow>& rows() const { return compliance_.effectors(); }

  /// The last linearisation's factor serves for the next fits as long as they converge with it
  /// (newton_loop.hpp): for large bodies, of which it is most of the cost.
  void KeepFactor(bool keep);

  void SetSites(const std::vector<FitSite>& sites);
  /// Prior knowledge about lambda_f: mean zero with this inverse covariance [3k x 3k], 1/N^2. None
  /// after SetSites.
  void SetForcePrior(const fem::QpMatrix& information) { prior_information_ = information; }
  const fem::QpMatrix& force_prior() const { return prior_information_; }
  /// A cable that is about to become slack can come out neither taut nor slack where noisy rows
  /// pull either way: the fit then stands as long as the cable pushes no more than this; at first
  /// 0.
  void TolerateCablesThatPush(double most_N) { most_push_N_ = most_N; }
  /// No exact step changes a contact's force by more, which keeps Newton's steps where they
  /// converge; at first there is no limit.
  void LimitForceStep(double most_N) { longest_step_N_ = most_N; }
  /// A budget that counts work instead of seconds, in substitutions of a single right-hand side, so
  /// that the same input gives the same result: for this fitter's fits from now on. It must outlive
  /// the budget. Infinite: no limit.
  fem::TimeBudget BudgetOfWork(double work) {
    counts_work_ = true;
    return fem::TimeBudget(work, [this] { return work_; });
  }
  /// What others do for the same frame.
  void AddWork(double work) { work_ += work; }
  /// In place of Config::frame_tolerance, for the fits from now on.
  void SetTolerance(double relative) { config_.frame_tolerance = relative; }
  /// Static solves that a fit may try where Newton's steps diverge; at first 8.
  void LimitContinuationSteps(int most) { most_continuation_steps_ = most; }
  /// Whether fits tell modulus_sensitivity_N, which costs a substitution each; at first they do.
  void TellModulusSensitivity(bool tell) { tell_modulus_sensitivity_ = tell; }
  /// A factor at `state`, where a fit ended, for the fits that begin there. Where there is none,
  /// the next fit makes one.
  void RenewFactor(const ModelState& state) {
    static_cast<void>(Linearise(state, /*allow_shift=*/false));
  }
  bool has_factor() const { return factor_known_; }
  /// Somebody else has used the model's linearisation.
  void ForgetFactor() { factor_known_ = evaluated_.valid = false; }
  int SiteCount() const { return static_cast<int>(sites_.size()); }

  /// Moves `state` (which must be near an equilibrium) to the fit; without sites to the equilibrium
  /// that the cables ask for. The result stays valid until the next call. Where the status is
  /// neither kOk nor kBudgetReached, `state` is a sound one from before. After the first frame
  /// nothing is allocated as long as no restoration is needed.
  const ForceFit& Fit(const RowTargets& targets, const std::vector<robot::CableCommand>& cables,
                      ModelState* state, const fem::TimeBudget& budget = {});

  const ForceFit& fit() const { return fit_; }  ///< of the last Fit

  /// Where the last converged fit of these sites ended; `valid` is false where there is none.
  const ModelState& last_good() const { return last_good_; }

  /// Response of the rows to lambda_f with the cable inputs imposed, about the last fit [rows x
  /// 3k], m/N.
  const Eigen::MatrixXd& Response() const { return elimination_.G(); }
  /// How the rows answer to nodal forces, a column each [3n x m], with the cable inputs imposed
  /// [rows x m], m.
  void RespondTo(const Eigen::Ref<const Eigen::MatrixXd>& forces_N, const Eigen::VectorXd& x_m,
                 Eigen::MatrixXd* row_motions_m);
  /// G' S^-1 G and the prior about the last fit [3k x 3k], 1/N^2.
  fem::QpMatrix Information(const RowTargets& targets) const;

  /// Weighted residual that would be left if a force at one more site joined in, to first order
  /// about `state`; one value for each of `candidates`, infinite for one that cannot be told from
  /// the sites before. Not ok where the state cannot be linearised.
  Status Screen(const RowTargets& targets, const std::vector<robot::CableCommand>& cables,
                const ModelState& state, const std::vector<FitSite>& candidates,
                std::vector<double>* chi_squared);

  /// Weighted residual of the rows at `state` [and `residual_m` itself, one for each row].
  double ChiSquared(const RowTargets& targets, const ModelState& state,
                    Eigen::VectorXd* residual_m) const;

 private:
  /// What the present Fit works on.
  struct Frame {
    const RowTargets* targets = nullptr;
    const std::vector<robot::CableCommand>* cables = nullptr;
    const fem::TimeBudget* budget = nullptr;
    ModelState* state = nullptr;
    bool observability_known = false;
  };

  Status PrepareExactStep() override;
  Status PrepareChordStep() override { return Status::Ok(); }  // Try has solved for it
  Status PrepareFrozenFactorStep() override;
  double StartError() const override { return start_error_; }
  Status Try(double length, bool last) override;
  double TrialError() const override { return trial_error_; }
  bool StepWasCut() const override { return step_was_cut_; }
  void AcceptTrial() override;
  void Accelerate();

  Status RunLoop(bool careful);
  Status FitWithContinuation();
  Status Restore();
  Status StepToEquilibrium(double fraction);
  Status Linearise(const ModelState& state, bool allow_shift);
  bool IsEvaluated(const ModelState& state) const;
  Status SolveInObservableDirections(const ModelState& state);
  Status SolveQp(const RowTargets& targets, const std::vector<robot::CableCommand>& cables,
                 const ModelState& state);
  double Error(const ModelState& state) const;
  double BalanceError(const ModelState& state) const;
  double CableError(const ModelState& state) const;
  double LargestChange(const ModelState& state) const;
  double StepShare(const ModelState& state) const;
  void UpdateWeight();
  void UpdateExternalForce(const Eigen::VectorXd& lambda_f_N);

  Status Conclude();
  Status CheckTensions(const ModelState& state) const;
  void ModulusSensitivity(const RowTargets& targets, const ModelState& state);

  robot::RobotModel& model_;
  Config config_;
  robot::Compliance compliance_;
  fem::StaticSolver equilibrium_;  ///< for restorations
  ActuatorCondensation elimination_;
  std::vector<FitSite> sites_;
  ObservableSubspace directions_;
  fem::QpMatrix prior_information_;
  bool keep_factor_ = false;
  bool tell_modulus_sensitivity_ = true;
  int most_continuation_steps_ = 8;
  double most_push_N_ = 0.0;
  double longest_step_N_ = 0.0;  ///< 0: no limit
  double work_ = 0.0;
  bool counts_work_ = false;
  /// Steps that a new factor would have spared, since the last one was made.
  double factor_age_cost_ = 0.0;
  bool factor_known_ = false;     ///< the linearisation has a factor that may be kept
  bool columns_current_ = false;  ///< the compliance has the columns of the present sites
  double start_error_ = 0.0;
  fem::QpVector qp_start_;
  ForceFit fit_;
  Frame frame_;
  ModelState start_, trial_, last_good_;
  AndersonAccelerator secants_;  ///< with the present factor
  FitVariables from_, step_, correction_;
  ModelState evaluated_;  ///< where linearisation and compliance have the residual of
  double trial_error_ = 0.0;
  bool step_was_cut_ = false;
  double linearised_error_ = 0.0;     ///< of the state at which the tangent was taken
  Eigen::VectorXd weight_N_;          ///< [3n] gravity
  Eigen::VectorXd external_force_N_;  ///< [3n]
  Eigen::VectorXd new_lambda_f_, new_lambda_a_;
  Eigen::VectorXd nodal_, gradient_, cable_gradient_, effector_motion_, cable_motion_;
  Eigen::MatrixXd responses_;          ///< [reduced x m]
  Eigen::MatrixXd response_motion_m_;  ///< [rows x m]
};

}  // namespace palpate::force_estimation
