// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/actuator_chain.hpp"
#include "components/diagnosis/forward/fault_model.hpp"
#include "components/diagnosis/forward/history.hpp"
#include "components/diagnosis/forward/model_hypothesis.hpp"
#include "components/diagnosis/forward/sample_in_parts.hpp"
#include "components/diagnosis/forward/sample_solver.hpp"
#include "components/diagnosis/forward/shapes_in_time.hpp"
#include "components/diagnosis/forward/simulation.hpp"
#include "components/diagnosis/forward/sticking.hpp"

namespace palpate::diagnosis {

/// Computes where the markers would be seen at every sample of an experiment, under a hypothesis,
/// and the derivatives with respect to the parameters of faults. Recordings are shared by threads,
/// each with a model of its own.
class Simulator {
 public:
  /// `observed` must outlive it.
  Simulator(const ObservedExperiment& observed, int threads);

  /// Equilibria of all samples. A sample that fails has a status that says so and no markers (NaN).
  /// Begins from those of `start` where there is one, of the same mesh, and ends then where a first
  /// one fails.
  Simulation Run(const ModelHypothesis& hypothesis, const Simulation* start = nullptr,
                 Detail detail = Detail::kParts) const;

  /// Fills jacobian_m of all samples: columns for every parameter of `faults`, in their order, z at
  /// `z` [parameters of all]; `hypothesis` is what these made. The columns of faults that are
  /// not `wanted` [faults] stay as they are, 0 where there were none.
  void Differentiate(const ModelHypothesis& hypothesis, const FaultModelList& models,
                     const Eigen::VectorXd& z, const std::vector<bool>& wanted,
                     const ModelHypothesis& nominal, Simulation* simulation) const;

  /// Puts differences of simulations in the place of the columns of faults of which Differentiate
  /// leaves out what matters (FaultModel::NeedsSimulation); one that cannot be simulated there
  /// keeps them.
  void DifferentiateBySimulation(const ModelHypothesis& nominal, const FaultModelList& models,
                                 const Eigen::VectorXd& z, Simulation* simulation) const;

  /// [samples] all shapes of those with depth frames, one for each part of a motion; `simulation`
  /// is of this hypothesis. Empty where it failed, or there are no depth frames.
  std::vector<ShapesInTime> Shapes(const ModelHypothesis& hypothesis,
                                   const Simulation& simulation) const;

  const HistoryOperator& history() const { return history_; }
  int threads() const { return threads_; }

 private:
  /// [threads] of one hypothesis, each made where it is first needed.
  using Solvers = std::vector<std::unique_ptr<SampleSolver>>;

  /// [samples] parts of those, as they slide in a robot of which `simulated` is known.
  std::vector<std::vector<SamplePart>> PartsOf(const ModelHypothesis& hypothesis,
                                               const Simulation& simulated) const;
  bool Sweep(const ModelHypothesis& hypothesis, bool is_near, Detail detail,
             const std::vector<std::vector<SamplePart>>& parts, const std::vector<bool>& is_to_do,
             Solvers* solvers, Simulation* simulation) const;

  const ObservedExperiment& observed_;
  int threads_;
  ActuatorChain actuators_;
  Sticking sticking_;
  HistoryOperator history_;
};

/// Parameters of all faults together.
Eigen::Index ParameterCount(const FaultModelList& models);

/// What faults make of the nominal hypothesis.
ModelHypothesis HypothesisWith(const ModelHypothesis& nominal, const FaultModelList& models,
                               const Eigen::VectorXd& z);

}  // namespace palpate::diagnosis
