// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"

namespace palpate::diagnosis {

/// How actuators turn commands into cable and pressure. By default exactly. Chambers count as their
/// pistons (libs/robot/actuator.hpp).
struct ActuatorSettings {
  explicit ActuatorSettings(int actuators);

  Eigen::MatrixXd mixing;  ///< [square] what share of each one's command (column) an actuator gets
  double delay_s = 0.0;    ///< of cables, as the next
  double tau_s = 0.0;      ///< of a first order, after the delay
  Eigen::VectorXd gain;    ///< [actuators] g: takes in, or presses with, 1 + g times as much
  Eigen::VectorXd offset_m;  ///< [actuators] of cables: takes in so much more
  Eigen::VectorXd play_m;    ///< [actuators] of cables: full width
  // Of chambers that are commanded by pressure, [actuators] each:
  Eigen::VectorXd pressure_zero_N;  ///< what its sensor reads as zero
  Eigen::VectorXd valve_tau_s;      ///< of the valve, first order
  Eigen::VectorXd leak_ratio;       ///< conductance of the leak over that of the valve
  Eigen::VectorXd blocked_share;    ///< of the pressure, that is kept from blocked_from_s on
  Eigen::VectorXd blocked_from_s;

  bool operator==(const ActuatorSettings&) const = default;
};

/// A part of a sample's frames, over which the body may be taken to stand still.
struct SamplePart {
  double share = 0.0;        ///< of the sample's frames
  double t_s = 0.0;          ///< mean of their stamps
  Eigen::VectorXd taken_in;  ///< [actuators] as ActuatorChain::At, mean over the part
  std::vector<int> times;    ///< of its frames, among ActuatorChain::t_s
  Eigen::VectorXd sliding;   ///< [eyelets that rub] mean CableFriction::sliding; empty: 1
};

/// The actuators through the whole experiment. Cables: mixing, lag, gain and offset, play, in this
/// order; the play begins in its middle. Offset and play are of cables that are commanded by
/// displacement. Chambers: mixing, gain and zero of the pressure sensor, valve and leak, which make
/// tau dp/dt = u - (1 + ratio) p, and what blocks the valve.
class ActuatorChain {
 public:
  /// `observed` must outlive it.
  explicit ActuatorChain(const ObservedExperiment& observed);

  /// [actuators x samples] what the actuators take in, m, or pull or press with, N: mean over the
  /// frames of each sample; NaN: not driven.
  Eigen::MatrixXd At(const ActuatorSettings& settings) const;
  /// [samples] parts in order of time: one of a sample in which nothing is moved, up to five of a
  /// motion, in which a cable may get taut.
  std::vector<std::vector<SamplePart>> PartsAt(const ActuatorSettings& settings) const;
  /// [actuators x samples] 1 where a cable was last taken in, -1 let out, 0: not moved yet.
  Eigen::MatrixXi Sliding(const ActuatorSettings& settings) const;
  /// [times] all stamps of commands and frames, rising.
  const std::vector<double>& t_s() const { return t_s_; }
  /// [actuators x times] what the actuators take in or pull with.
  Eigen::MatrixXd Path(const ActuatorSettings& settings) const;

 private:
  /// Where actuators are, [actuators] each.
  struct Place {
    double t_s;
    Eigen::VectorXd commanded;  ///< of chambers before the valve
    Eigen::VectorXd followed;
    Eigen::VectorXd taken_in;  ///< NaN: not known yet
    Eigen::VectorXd kept;      ///< by a blocked valve; NaN: not blocked yet
  };

  Eigen::VectorXd Commanded(const ActuatorSettings& settings, double t_s) const;
  bool IsChamber(Eigen::Index actuator) const;
  void GoToAsCable(Eigen::Index c, double h_s, double next, const ActuatorSettings& settings,
                   Place* now) const;
  void GoToAsChamber(Eigen::Index c, double t_s, double next, const ActuatorSettings& settings,
                     Place* now) const;
  /// On to a later time, before which the command does not turn.
  void GoTo(double t_s, const ActuatorSettings& settings, Place* now) const;

  const ObservedExperiment& observed_;
  std::vector<double> t_s_;
  std::vector<std::vector<int>> times_of_;  ///< [samples] indices of its frames
};

}  // namespace palpate::diagnosis
