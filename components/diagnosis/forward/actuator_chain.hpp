// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"

namespace palpate::diagnosis {

/// How actuators turn commands into cable. By default exactly.
struct ActuatorSettings {
  explicit ActuatorSettings(int cables);

  Eigen::MatrixXd
      mixing;  ///< [cables x actuators] what share of each actuator's command a cable gets
  double delay_s = 0.0;
  double tau_s = 0.0;        ///< of a first order, after the delay
  Eigen::VectorXd gain;      ///< [cables] g: takes in 1 + g times as much
  Eigen::VectorXd offset_m;  ///< [cables] takes in so much more
  Eigen::VectorXd play_m;    ///< [cables] full width

  bool operator==(const ActuatorSettings&) const = default;
};

/// A part of a sample's frames, over which the body may be taken to stand still.
struct SamplePart {
  double share = 0.0;        ///< of the sample's frames
  double t_s = 0.0;          ///< mean of their stamps
  Eigen::VectorXd taken_in;  ///< [cables] as ActuatorChain::At, mean over the part
  std::vector<int> times;    ///< of its frames, among ActuatorChain::t_s
  Eigen::VectorXd sliding;   ///< [eyelets that rub] mean CableFriction::sliding; empty: 1
};

/// The actuators through the whole experiment: mixing, lag, gain and offset, play, in this order;
/// the play begins in its middle. Offset and play are of cables that are commanded by displacement.
class ActuatorChain {
 public:
  /// `observed` must outlive it.
  explicit ActuatorChain(const ObservedExperiment& observed);

  /// [cables x samples] what the actuators take in, m, or pull with, N: mean over the frames of
  /// each sample; NaN: not driven.
  Eigen::MatrixXd At(const ActuatorSettings& settings) const;
  /// [samples] parts in order of time: one of a sample in which nothing is moved, up to five of a
  /// motion, in which a cable may get taut.
  std::vector<std::vector<SamplePart>> PartsAt(const ActuatorSettings& settings) const;
  /// [cables x samples] 1 where a cable was last taken in, -1 let out, 0: not moved yet.
  Eigen::MatrixXi Sliding(const ActuatorSettings& settings) const;
  /// [times] all stamps of commands and frames, rising.
  const std::vector<double>& t_s() const { return t_s_; }
  /// [cables x times] what the actuators take in or pull with.
  Eigen::MatrixXd Path(const ActuatorSettings& settings) const;

 private:
  /// Where actuators are, [cables] each.
  struct Place {
    double t_s;
    Eigen::VectorXd commanded;
    Eigen::VectorXd followed;
    Eigen::VectorXd taken_in;  ///< NaN: not known yet
  };

  Eigen::VectorXd Commanded(const ActuatorSettings& settings, double t_s) const;
  /// On to a later time, before which the command does not turn.
  void GoTo(double t_s, const ActuatorSettings& settings, Place* now) const;

  const ObservedExperiment& observed_;
  std::vector<double> t_s_;
  std::vector<std::vector<int>> times_of_;  ///< [samples] indices of its frames
};

}  // namespace palpate::diagnosis
