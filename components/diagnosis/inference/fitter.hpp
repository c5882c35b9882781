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
  bool complete = false;  ///< all columns of `model` are of this place
  bool arrived = false;   ///< and it cannot be taken further
  Posterior posterior;    ///< of all parameters
};

/// Fits robots with faults to an experiment: simulates, linearises, infers, and again from there.
/// Of a nominal robot what has one sign only (play, creep, delay) stays linear while it is small:
/// its derivative has two sides.
class Fitter {
 public:
  /// All must outlive it. After `limit` a fit ends at the first place that it was simulated at, but
  /// for that of a nominal robot.
  Fitter(const ObservedExperiment& observed, const robot::RobotBody& body,
         const HypothesisSet& hypotheses, const NoiseModel& noise, int threads,
         TimeLimit limit = {}, const FitterTuning& tuning = {});

  /// The robot as its file has it (where its simulation is known: `simulated`), its linear model,
  /// and what a nominal robot makes of it.
  Fit AsBuilt(const Simulation* simulated = nullptr) const;
  /// With these faults, from what `start` is fitted to. Ends where the linear model reaches, or
  /// after so many rounds, or where the evidence with a further fault stays below that of `start`;
  /// a step after which the data fit worse is damped. Only what the faults do is computed again on
  /// the way: what others do, tolerances as well, is taken from `start`, which is good enough to
  /// find the place, not to stand on it (Complete).
  Fit Refine(const std::vector<int>& faults, const Fit& start, int most_rounds,
             Detail detail) const;
  /// With as many rounds as such faults need, in all detail at the end.
  Fit Refine(const std::vector<int>& faults, const Fit& start) const;
  /// With these faults as large as they are likely to be, all else as `start` has it, in all
  /// detail: where one that is there or not, and moves the body far, is fitted from.
  Fit WithFaults(const std::vector<int>& faults, const Fit& start) const;
  /// The same fit in all detail, with what every fault does computed where it is, and taken further
  /// until the data fit where it leads as well as it promises. One that could not be simulated
  /// stays as it is.
  Fit Complete(Fit fit) const;
  /// A fit where it is, of measurements that have changed since (the surface matched again), in all
  /// detail; it may lead elsewhere now.
  Fit Remeasured(Fit fit) const;
  /// The same without what faults do there.
  Fit Resimulated(Fit fit) const;
  /// The robot as a fit has it.
  ModelHypothesis HypothesisAt(const Fit& fit) const {
    return HypothesisWith(nominal_, models_, fit.z);
  }
  /// [samples] where it is while depth frames are taken.
  std::vector<ShapesInTime> Shapes(const Fit& fit) const {
    return simulator_.Shapes(HypothesisAt(fit), fit.simulation);
  }
  /// What a linear model says of faults, without another simulation.
  Posterior LinearPosterior(const Fit& about, const std::vector<int>& faults) const;

  const HypothesisSet& hypotheses() const { return hypotheses_; }
  const NoiseModel& noise() const { return noise_; }
  bool IsOutOfTime() const { return limit_.IsOver(); }
  /// [3 x markers] of the undeformed body, robot frame.
  const Eigen::Matrix3Xd& marker_rest_m() const { return marker_rest_m_; }

 private:
  /// `damping`: a step of Levenberg and Marquardt, so many times what the data say of each
  /// parameter by itself; it shortens most what only trades one parameter for another, as size for
  /// place.
  Eigen::VectorXd PointFrom(const Fit& about, const std::vector<int>& faults,
                            double damping = 0.0) const;
  bool HasKinks(const std::vector<int>& faults) const;
  Eigen::VectorXd FaultStart(const std::vector<int>& faults, const Fit& start) const;
  /// Chi-squared of data and prior at `z`, as the linear model of `fit` has it.
  double MisfitAt(const Fit& fit, const Eigen::VectorXd& z) const;
  /// Whether a fit's linear model was made where its posterior is.
  bool IsNear(const Fit& fit) const;
  /// With the same faults at `z`, what faults do there taken from `fit`.
  Fit MovedTo(const Eigen::VectorXd& z, const Fit& fit) const;
  /// With what every fault does there; what only runs tell, from `near` where there is one.
  Fit InAllDetail(Fit fit, const Fit* near = nullptr) const;
  Fit Continued(Fit fit) const;
  /// Whether the columns of fault k in a fit are of simulations.
  bool IsKnownBySimulation(int k, const Fit& fit) const;
  void Differentiate(const std::vector<bool>& wanted, const Simulation* others, Fit* fit) const;

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
