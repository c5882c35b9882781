// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/inference/hypothesis_set.hpp"
#include "components/diagnosis/inference/linear_model.hpp"
#include "components/diagnosis/inference/time_limit.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// When fits end, and how their steps are damped. More rounds and smaller limits cost simulations
/// and gain evidence, of which selection asks for ln BF 10.
struct FitterTuning {
  int most_rounds = 6;               ///< simulations of one refinement
  int most_rounds_over_kinks = 10;   ///< of faults whose effect has kinks (obstacles), coarse
  int most_failures_over_kinks = 2;  ///< steps in a row that fit worse, before such a one ends
  int rounds_to_hope = 3;            ///< after which a fault without evidence is given up
  double settled_ln_evidence = 0.5;  ///< a round that changes less is the last
  double settled_misfit = 0.01;      ///< of chi-squared: a step that is worse by less ends the fit
  double settled_over_kinks = 0.03;  ///< the same over kinks, where chi-squared is uneven
  double still_to_go = 0.2;     ///< of chi-squared, that the linear model may promise at the end
  double near_fault = 0.5;      ///< a step below this share of a fault's deviation is the last
  double near_tolerance = 1.5;  ///< and below so many tolerances of any other parameter
  double stretched_tolerances = 2.0;   ///< a null model with more of one is far from the nominal
  double one_sided_tolerances = 2.0;   ///< one-sided parameters (backlash) below are held at zero
  double least_damping = 0.03;         ///< Levenberg-Marquardt, of the diagonal
  double damp_more = 10.0;             ///< after a step that fits worse
  double damp_less = 3.0;              ///< after one that fits better
  int most_continuations = 4;          ///< full steps of a complete fit
  int most_failed_continuations = 2;   ///< of these, steps that are halved
  double continued_chi_squared = 2.0;  ///< gain that such a step must promise
};

/// A robot with some faults, fitted to an experiment.
struct Fit {
  Status status;
  std::vector<int> faults;  ///< numbers in the HypothesisSet
  Eigen::VectorXd z;        ///< [all parameters] where `simulation` and `model` are
  Simulation simulation;
  LinearModel model;
  /// How samples bend about their middles is of a body held as with these faults.
  bool bends_known = true;
  /// The columns of `model` are of this place, as far as they have an effect under the hypothesis.
  bool complete = false;
  bool of_all_faults = false;  ///< and so are all others
  bool arrived = false;        ///< it is complete and cannot be taken further
  Posterior posterior;         ///< of all parameters
  /// By how much ln p the first simulated step fitted worse than the linear model had promised.
  double ln_surprise = 0.0;
};

/// Fits robots with faults to an experiment: simulates, linearises, infers, and again from there.
/// In the null model one-sided parameters (backlash, creep, delay)
/// stay linear while they are small: their derivative has two sides.
class Fitter {
 public:
  /// All must outlive it. After `limit` a fit ends at its first simulation; that of the null model
  /// goes on.
  Fitter(const ObservedExperiment& observed, const robot::RobotBody& body,
         const HypothesisSet& hypotheses, const NoiseModel& noise, int threads,
         TimeLimit limit = {}, const FitterTuning& tuning = {});

  /// The nominal robot (`simulated`: its simulation, if known), its linear model, and the posterior
  /// of the null model.
  Fit AsBuilt(const Simulation* simulated = nullptr) const;
  /// Damped Gauss-Newton fit of the hypothesis `faults` from `start`. Ends at convergence, after
  /// `most_rounds`, or where the evidence with a further fault stays below that of `start`. Only
  /// the Jacobian of `faults` is recomputed; all other columns are those of `start`. That is good
  /// enough to find the optimum, not to compare hypotheses there (Complete).
  Fit Refine(const std::vector<int>& faults, const Fit& start, int most_rounds,
             Detail detail) const;
  /// With as many rounds as such faults need, all parts of samples at the end.
  Fit Refine(const std::vector<int>& faults, const Fit& start) const;
  /// The hypothesis `faults` at its prior mean, all else as in `start`, fully differentiated: the
  /// start for faults that are present or absent, and move the body far (exchanged cables).
  Fit WithFaults(const std::vector<int>& faults, const Fit& start) const;
  /// The same fit with all Jacobian columns recomputed that have an effect under its hypothesis,
  /// continued until the data agree with the linear model's prediction. A fit that could not be
  /// simulated is returned as it is.
  Fit Complete(Fit fit) const;
  /// The same complete fit with the columns of all faults, as the search for a further one needs
  /// them.
  Fit WithAllFaults(Fit fit) const;
  /// The fit at its parameters with measurements that have changed since (the surface matched
  /// again), fully differentiated; its optimum may be elsewhere now.
  Fit Remeasured(Fit fit) const;
  /// The same with the old Jacobian.
  Fit Resimulated(Fit fit) const;
  /// The hypothesis at the fit's parameters.
  ModelHypothesis HypothesisAt(const Fit& fit) const {
    return HypothesisWith(nominal_, models_, fit.z);
  }
  /// [samples] shapes of the body while depth frames are taken.
  std::vector<ShapesInTime> Shapes(const Fit& fit) const {
    return simulator_.Shapes(HypothesisAt(fit), fit.simulation);
  }
  /// Posterior of the hypothesis `faults` by the linear model of `about`, without a simulation.
  Posterior LinearPosterior(const Fit& about, const std::vector<int>& faults) const;

  /// Whether a fit has more than two tolerances of anything.
  bool IsStretched(const Fit& fit) const;

  const HypothesisSet& hypotheses() const { return hypotheses_; }
  const NoiseModel& noise() const { return noise_; }
  bool IsOutOfTime() const { return limit_.IsOver(); }
  /// [3 x markers] of the undeformed body, robot frame.
  const Eigen::Matrix3Xd& marker_rest_m() const { return marker_rest_m_; }

 private:
  /// `scale`: deviations of the discrepancies. `damping`: a step of Levenberg and Marquardt, so
  /// many times what the data say of each parameter by itself; it shortens most what only trades
  /// one parameter for another, as size for place.
  Eigen::VectorXd PointFrom(const Fit& about, const std::vector<int>& faults,
                            const Eigen::VectorXd& scale, double damping = 0.0) const;
  LinearModel LinearModelOf(const Fit& fit) const;
  bool HasKinks(const std::vector<int>& faults) const;
  Fit Simulated(const Eigen::VectorXd& z, const std::vector<int>& faults, const Simulation& from,
                Detail detail, const std::vector<bool>& wanted) const;
  Eigen::VectorXd FaultStart(const std::vector<int>& faults, const Fit& start) const;
  /// Chi-squared of data and prior at `z`, as the linear model of `fit` has it, with the
  /// discrepancies' deviations `scale`.
  double MisfitAt(const Fit& fit, const Eigen::VectorXd& z, const Eigen::VectorXd& scale) const;
  /// The same of the hypothesis `faults`, which need not be those that `about` was fitted with.
  double MisfitAt(const Fit& about, const std::vector<int>& faults, const Eigen::VectorXd& z,
                  const Eigen::VectorXd& scale) const;
  /// The same where the fit was simulated, with the discrepancies at their best there.
  double MisfitOf(const Fit& fit, const Eigen::VectorXd& scale) const;
  /// Whether a fit's linear model was made where its posterior is.
  bool IsNear(const Fit& fit, const Eigen::VectorXd& scale) const;
  /// With the same faults at `z`, what faults do there taken from `fit`.
  Fit MovedTo(const Eigen::VectorXd& z, const Fit& fit) const;
  /// With what every fault does there; what only runs tell, from `near` where there is one.
  Fit InAllDetail(Fit fit, const Fit* near = nullptr) const;
  Fit Continued(Fit fit) const;
  /// Whether the columns of fault k in a fit are of simulations.
  bool IsKnownBySimulation(int k, const Fit& fit) const;
  Simulation SimulateFrom(const Simulation& from, const Eigen::VectorXd& z, Detail detail) const;
  void Differentiate(const std::vector<bool>& wanted, Fit* fit) const;
  /// The linear model where the fit was simulated, and the posterior.
  void Infer(Fit* fit) const;
  /// [faults] whether one, or another of its name, may have an effect under a hypothesis.
  std::vector<bool> Acting(const std::vector<int>& faults) const;

  const ObservedExperiment& observed_;
  const HypothesisSet& hypotheses_;
  FaultModelList models_;  ///< all of the hypothesis set
  NoiseModel noise_;
  ModelHypothesis nominal_;
  Simulator simulator_;
  TimeLimit limit_;
  FitterTuning tuning_;
  Eigen::Matrix3Xd marker_rest_m_;
  GaussianPrior null_prior_;
};

}  // namespace palpate::diagnosis
