// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <vector>

#include "components/virtual_robot/effects.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::virtual_robot {

/// From the commands to how much cable the actuators take in: swapped_cables, drive_coupling,
/// lag (a delay, then a first order), cable_gain, cable_offset, backlash (play operator, beside
/// the play of the robot file), in this order. Drive r is the one that the robot file names like
/// cable r. NaN: not driven.
class ActuatorChain {
 public:
  /// Throws InputError where an effect does not fit the cables.
  ActuatorChain(const std::vector<robot::BodyCable>& cables, const Effects& effects);

  /// At rest at these commands [cables] since ever, the play in the middle.
  void Reset(double t_s, const Eigen::VectorXd& command_m);
  /// What the cables are at `t_s`, later than the last Reset or Commit, the commands having gone
  /// linearly to `command_m`. A trial: only Commit makes it so.
  void Propose(double t_s, const Eigen::VectorXd& command_m);
  void Commit();

  /// [cables] m of cable that was taken in, counted from the undeformed body.
  const Eigen::VectorXd& pulled_in_m() const { return proposed_.pulled_in_m; }
  /// The cable that this actuator pulls.
  int CableOfActuator(int actuator) const { return cable_of_actuator_[At(actuator)]; }

 private:
  struct Commanded {
    double t_s = 0.0;
    Eigen::VectorXd command_m;  ///< [cables] coupled
  };
  struct Actuators {
    Commanded commanded;
    Eigen::VectorXd delayed_m;   ///< [cables] after the delay
    Eigen::VectorXd followed_m;  ///< after the first order
    Eigen::VectorXd pulled_in_m;
  };

  Eigen::VectorXd Coupled(const Eigen::VectorXd& command_m) const;
  Eigen::VectorXd Delayed(const Commanded& latest) const;
  double Follow(double from_m, double u0_m, double u1_m, double h_s) const;
  /// Gain and offset, without the play.
  double Geared(Eigen::Index cable, double followed_m) const;

  std::vector<int> cable_of_actuator_;
  Eigen::MatrixXd coupling_;  ///< [cables x cables]
  double delay_s_ = 0.0;
  double tau_s_ = 0.0;
  Eigen::VectorXd gain_;
  Eigen::VectorXd offset_m_;
  Eigen::VectorXd play_m_;

  std::deque<Commanded> history_;  ///< as far back as the delay reaches
  Actuators now_;
  Actuators proposed_;
};

}  // namespace palpate::virtual_robot
