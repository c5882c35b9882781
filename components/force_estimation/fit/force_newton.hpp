// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/fit/anderson_accelerator.hpp"
#include "components/force_estimation/fit/force_qp.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/newton_loop.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// A configuration of the model and the forces on it.
struct ModelState {
  bool valid = false;          ///< the other members are set
  bool balanced = false;       ///< an equilibrium within the tolerance; else only near one
  Eigen::VectorXd x_m;         ///< [3n] nodes, robot frame
  Eigen::VectorXd lambda_a_N;  ///< [cables]
  Eigen::VectorXd lambda_f_N;  ///< [3k] x, y, z of each contact, robot frame
};

/// One more contact, fitted to first order (ForceNewton::Screen).
struct ScreenedSite {
  double chi_squared = 0.0;  ///< of all rows; infinite: its force cannot be told from the others'
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< robot frame
};

struct ForceFit {
  Status status;               ///< kBudgetReached: usable as a start, but not converged
  int iterations = 0;          ///< linearisations
  int chord_steps = 0;         ///< Newton steps with a frozen factor
  int continuation_steps = 0;  ///< load steps along equilibria, where Newton's method diverged
  double error = 0.0;          ///< relative, compared with Config::frame_tolerance
  double chi_squared = 0.0;
  Eigen::VectorXd residual_m;     ///< [rows] measured - model; 0 where not measured
  Eigen::MatrixXd covariance_N2;  ///< [3k x 3k] from weights and priors
  /// [3k x u] Error of the fitted forces for each newton along a tangent that was not fitted, and
  /// the site of each tangent [u] (ObservableSubspace::unfitted).
  fem::QpMatrix unfitted_error;
  std::vector<int> unfitted_sites;
  Eigen::VectorXd modulus_sensitivity_N;     ///< [3k] dlambda_f / dln E
  std::vector<Observability> observability;  ///< [k]
  std::vector<int> unknowns;                 ///< [k] force components that were fitted
};

/// Covariance of the force at a site, N^2, from tangents that were not fitted: `sigma_N` of a site
/// is the prior sigma of its tangential force. Zero where all were fitted.
template <typename SigmaOfSite>
Eigen::Matrix3d UnfittedCovariance_N2(const ForceFit& fit, size_t site, SigmaOfSite sigma_N) {
  Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();
  for (size_t k = 0; k < fit.unfitted_sites.size(); ++k) {
    const Eigen::Vector3d error_N =
        sigma_N(static_cast<size_t>(fit.unfitted_sites[k])) *
        fit.unfitted_error.block<3, 1>(static_cast<Eigen::Index>(3 * site),
                                       static_cast<Eigen::Index>(k));
    covariance_N2 += error_N * error_N.transpose();
  }
  return covariance_N2;
}

/// Cost of a factorisation, in substitutions of a single right-hand side.
inline constexpr double kFactorWork = 8.0;
/// Cost of the substitution of some twenty right-hand sides at once, in the same unit.
inline constexpr double kColumnsWork = 2.0;

/// Contact forces at given sites that fit the observed rows by least squares, in static
/// equilibrium: the paper's QP (ForceQp), relinearised until it converges. Each step updates
/// forces, tensions and configuration together (Gauss-Newton), in the loop of fem/newton_loop.hpp.
/// Where that diverges, a continuation step solves for the equilibrium under new forces first.
///
/// The error of a fit is relative. It is the largest of
/// - the residual of the equilibrium, over the size of the forces;
/// - the length by which a cable misses its displacement, over its rest length;
/// - the change of the forces in the next step, over the largest contact force, or 1 N;
/// - a thousandth of the error of the state at which the tangent was taken, because the optimum and
///   its intervals depend on that tangent. This one is left out with KeepFactor.
class ForceNewton final : private fem::NewtonProblem {
 public:
  /// The observed rows are x, y and z of the robot's markers. `model` must outlive the fitter.
  ForceNewton(robot::RobotModel& model, const Config& config);

  /// Observes other rows; to be called before Fit.
  void SetRows(std::vector<robot::ObservationRow> rows);
  const std::vector<robot::ObservationRow>& rows() const { return compliance_.effectors(); }

  /// Whether the factor of the last linearisation is used in the next fits while they converge with
  /// it (newton_loop.hpp). For large bodies, whose cost is mostly the factorisation.
  void KeepFactor(bool keep);

  void SetSites(const std::vector<FitSite>& sites);
  /// Gaussian prior of lambda_f: mean zero, inverse covariance [3k x 3k], 1/N^2. SetSites removes
  /// it.
  void SetForcePrior(const fem::QpMatrix& information) { qp_.SetPrior(information); }
  const fem::QpMatrix& force_prior() const { return qp_.prior(); }
  /// Largest compression of a cable with which a fit is accepted; initially 0. Near the transition
  /// between taut and slack, noise may leave a cable in neither state.
  void TolerateCablesThatPush(double most_N) { most_push_N_ = most_N; }
  /// Largest change of a contact force in one exact step, which keeps Newton's method in the region
  /// where it converges; initially unlimited.
  void LimitForceStep(double most_N) { longest_step_N_ = most_N; }
  /// A budget of work instead of seconds for the fits from now on, in substitutions of a single
  /// right-hand side: the same input then gives the same result. The fitter must outlive it.
  /// Infinite: no limit.
  fem::TimeBudget BudgetOfWork(double work) {
    counts_work_ = true;
    return fem::TimeBudget(work, [this] { return work_; });
  }
  /// Adds work that others do for the same frame.
  void AddWork(double work) { work_ += work; }
  /// Replaces Config::frame_tolerance for the fits from now on.
  void SetTolerance(double relative) { config_.frame_tolerance = relative; }
  /// Continuation steps that a fit may try where Newton's method diverges; initially 8. 0: inputs
  /// that jumped are not followed either.
  void LimitContinuationSteps(int most) { most_continuation_steps_ = most; }
  /// Whether fits compute modulus_sensitivity_N, which costs a substitution each; initially true.
  void TellModulusSensitivity(bool tell) { tell_modulus_sensitivity_ = tell; }
  /// Factorises at `state`, where a fit ended, for the fits that begin there. Where that fails, the
  /// next fit factorises.
  void RenewFactor(const ModelState& state) {
    static_cast<void>(Linearise(state, /*allow_shift=*/false));
  }
  bool has_factor() const { return factor_.known; }
  /// To be called after other code has used the model's linearisation.
  void ForgetFactor() { factor_.known = factor_.evaluated.valid = false; }
  int SiteCount() const { return static_cast<int>(qp_.sites().size()); }

  /// Moves `state`, which must be near an equilibrium, to the fit; without sites to the equilibrium
  /// under the cable inputs. The result stays valid until the next call. Where the status is
  /// neither kOk nor kBudgetReached, `state` is one from before that may be used. After the first
  /// frame nothing is allocated unless a continuation step is needed.
  const ForceFit& Fit(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                      ModelState* state, const fem::TimeBudget& budget = {});

  const ForceFit& fit() const { return fit_; }  ///< of the last Fit

  /// End of the last converged fit of these sites; not `valid` where there is none.
  const ModelState& last_good() const { return last_good_; }

  /// Response G of the rows to lambda_f under the cable inputs, about the last fit [rows x 3k],
  /// m/N.
  const Eigen::MatrixXd& Response() const { return qp_.response().G(); }
  /// Displacements of the rows [rows x m], m, under nodal forces [3n x m], one case in each column,
  /// and the cable inputs.
  void RespondTo(const Eigen::Ref<const Eigen::MatrixXd>& forces_N, const Eigen::VectorXd& x_m,
                 Eigen::MatrixXd* row_motions_m);

  /// A force at one more site, to first order about `state`, the others fitted again: one result
  /// for each of `candidates`. Not ok where the state cannot be linearised.
  Status Screen(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                const ModelState& state, const std::vector<FitSite>& candidates,
                std::vector<ScreenedSite>* screened);

  /// Weighted residual of the rows at `state`; sets `residual_m` [rows].
  double ChiSquared(const RowTargets& targets, const ModelState& state,
                    Eigen::VectorXd* residual_m) const;

 private:
  /// Arguments and progress of the present Fit.
  struct Frame {
    const RowTargets* targets = nullptr;
    const std::vector<robot::ActuatorCommand>* cables = nullptr;
    const fem::TimeBudget* budget = nullptr;
    ModelState* state = nullptr;
    bool observability_known = false;  ///< the observable subspace is that of this frame
    double start_error = 0.0;          ///< of a start with a frozen factor
  };
  /// What the factor of the last linearisation may still be used for.
  struct FactorState {
    /// The linearisation has a factor of K itself, not of a shifted K: fits may freeze it.
    bool known = false;
    /// The compliance has the columns of the present sites by this factor; else they cost
    /// kColumnsWork.
    bool columns_current = false;
    /// State at which linearisation and compliance were last evaluated with this factor. A fit that
    /// starts there (`valid`, and equal) needs no substitution for its first step.
    ModelState evaluated;
    /// Relative error of the state at which the tangent was taken.
    double tangent_error = 0.0;
    /// Chord steps beyond one a fit since the factor was made: the cost that a new factor would
    /// have saved. Once they cost as much as a factor, one is made.
    double excess_work = 0.0;
  };
  /// Result of Try.
  struct Trial {
    ModelState state;
    double error = 0.0;
    bool was_cut = false;  ///< shorter than asked for, by LimitForceStep
  };

  Status PrepareExactStep() override;
  Status PrepareChordStep() override { return Status::Ok(); }  // Try has solved for it
  Status PrepareFrozenFactorStep() override;
  double StartError() const override { return frame_.start_error; }
  Status Try(double length, bool last) override;
  double TrialError() const override { return trial_.error; }
  bool StepWasCut() const override { return trial_.was_cut; }
  void AcceptTrial() override;
  void Accelerate();

  /// What continuation steps of one fit pass on.
  struct Continuation {
    double damping = 0.0;  ///< of the last step
    bool gains = true;     ///< the last step took enough of the residual away for another one
  };

  Status FitWithContinuation();
  Status RunNewton(bool exact_only);
  Status ContinueAlongEquilibria(Continuation* continuation);
  Status Balance(const Eigen::VectorXd& lambda_f_N, fem::StaticSolver* solver, ModelState* state);
  Status Linearise(const ModelState& state, bool allow_shift);
  bool IsEvaluated(const ModelState& state) const;
  Status SolveInObservableDirections(const ModelState& state);
  Status SolveQp(const ModelState& state, double damping = 0.0);
  double Error(const ModelState& state) const;
  double EquilibriumError(const ModelState& state) const;
  double CableError(const ModelState& state) const;
  double ForceChangeError(const ModelState& state) const;
  double StepFraction(const ModelState& state) const;
  void UpdateWeight();
  void UpdateExternalForce(const Eigen::VectorXd& lambda_f_N);

  Status Conclude();
  Status CheckTensions(const ModelState& state) const;
  void ModulusSensitivity(const RowTargets& targets, const ModelState& state);

  robot::RobotModel& model_;
  Config config_;
  robot::Compliance compliance_;
  fem::StaticSolver input_solver_;
  fem::StaticSolver continuation_solver_;
  ForceQp qp_;
  bool keep_factor_ = false;
  bool tell_modulus_sensitivity_ = true;
  int most_continuation_steps_ = 8;
  double most_push_N_ = 0.0;
  double longest_step_N_ = 0.0;  ///< 0: no limit
  bool counts_work_ = false;     ///< budgets are of work, not of seconds
  double work_ = 0.0;
  FactorState factor_;
  AndersonAccelerator accelerator_;  ///< of the present factor
  FitVariables from_, step_, correction_;
  ForceFit fit_;
  Frame frame_;
  Trial trial_;
  ModelState start_, last_good_;
  Eigen::VectorXd weight_N_;          ///< [3n] gravity
  Eigen::VectorXd external_force_N_;  ///< [3n]
  Eigen::VectorXd nodal_, gradient_, cable_gradient_, effector_motion_, cable_motion_;
  Eigen::MatrixXd responses_;          ///< [reduced x m]
  Eigen::MatrixXd response_motion_m_;  ///< [rows x m]
};

}  // namespace palpate::force_estimation
