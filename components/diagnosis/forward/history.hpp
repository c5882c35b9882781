// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <map>
#include <mutex>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/model_hypothesis.hpp"
#include "components/diagnosis/forward/simulation.hpp"

namespace palpate::diagnosis {

/// Interpolation of history variables through an experiment. A quantity that was computed at the
/// samples, with every command at zero, and where motions begin and end, is followed through all
/// times: linearly from one to the next, and to that of zero commands in the rests and where a
/// piece begins or ends with them. Where nothing is moved it stays, until a motion begins. Where a
/// load comes or goes it jumps, and where a body is let go that was held in its undeformed shape.
class HistoryOperator {
 public:
  explicit HistoryOperator(const ObservedExperiment& observed);

  /// Of what is remembered: the samples, zero commands, and for each sample where its piece begins
  /// and where that ends (of its first and its last sample).
  Eigen::Index ColumnCount() const { return 3 * std::ssize(observed_.samples) + 1; }

  /// [samples x columns] weights W: the convolution integral of exp(-(t - s) / tau) dF/ds ds at a
  /// sample, mean over its frames, is sum_k W(sample, k) F_k. Relaxed at the beginning. What was
  /// asked for once is kept; threads may ask at once.
  const Eigen::MatrixXd& Fading(double tau_s) const;

  /// Times in the course of a sample at which all is evaluated that goes up to its largest: each
  /// stands for equally many of its frames.
  static constexpr Eigen::Index kTimesPerSample = 5;
  struct Course {
    Eigen::MatrixXf now;
    Eigen::MatrixXf largest;  ///< that it was until then
  };
  /// [n x samples kLooks] n quantities in the course of the samples; `values` [n x columns].
  Course Follow(const Eigen::MatrixXf& values) const;

 private:
  /// A time at which the quantity is a combination of those that were computed.
  struct Node {
    double t_s = 0.0;
    Eigen::RowVectorXd share;  ///< [columns]
    bool sure = true;          ///< else carried on from parts of a sample
  };
  Eigen::MatrixXd ComputeFading(double tau_s) const;
  void AddPiece(std::size_t first, std::size_t last);
  std::vector<Node> NodesOf(std::size_t first, std::size_t last) const;
  void Add(Node node);
  Eigen::RowVectorXd Only(std::size_t column) const;
  Eigen::RowVectorXd Zero() const { return Only(observed_.samples.size()); }
  Eigen::RowVectorXd BeginOf(std::size_t first) const;
  Eigen::RowVectorXd EndOf(std::size_t last) const;
  bool IsAtZero(std::size_t sample, double t_s) const;

  const ObservedExperiment& observed_;
  Eigen::VectorXd largest_command_;  ///< [cables], m or N
  std::vector<Node> nodes_;          ///< by time
  mutable std::mutex mutex_;
  mutable std::map<double, Eigen::MatrixXd> fading_;  ///< by tau
};

/// [elements x samples HistoryOperator::kTimesPerSample] by how much the energy density lies below
/// the largest that each element has seen until then, J/m^3. It grows as the square of how far the
/// body is bent, and that is followed.
Eigen::MatrixXf BelowLargest_J_m3(const HistoryOperator& history, const Simulation& simulation);

/// A step of the damage of all samples towards what MullinsSoftening asks for after the energies of
/// `simulation`, the shorter the more these will answer (under a given load they go as 1 / eta^2).
void Soften(const MullinsSoftening& mullins, const HistoryOperator& history,
            const Simulation& simulation, std::vector<HistoryVariables>* history_variables);

/// Whether the hypothesis has history variables (creep or softening).
bool HasHistory(const ModelHypothesis& hypothesis);

/// Brings `past` [samples] to what `simulation`, which had another past, leaves of creep and of
/// softening. [samples] whether that is another by more than 1e-4 of all that could be left where
/// the body holds most.
std::vector<bool> UpdateHistory(const ModelHypothesis& hypothesis, const HistoryOperator& history,
                                const Simulation& simulation,
                                std::vector<HistoryVariables>* history_variables);

}  // namespace palpate::diagnosis
