// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/virtual_robot/effects.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot {

/// From the commands to the pressures in the chambers: swapped_tubes, the sensor's pressure_gain
/// and pressure_zero, then valve and leak, tau dp/dt = u - (1 + ratio) p, blocked_valve. Each is of
/// the chamber that is fed. A regulator holds the reading of its sensor, before the valve, at the
/// command u. All pressures are above ambient; NaN: open to the air.
class PressureSupply {
 public:
  /// Throws InputError where an effect does not fit the chambers.
  PressureSupply(const std::vector<robot::BodyChamber>& chambers,
                 const scenario::Scenario& scenario, const Effects& effects);

  /// At rest at these commands [chambers] since ever.
  void Reset(double t_s, const Eigen::VectorXd& command_Pa);
  /// What the chambers have at `t_s`, later than the last Reset or Commit, the commands having gone
  /// linearly to `command_Pa`. A trial: only Commit makes it so.
  void Propose(double t_s, const Eigen::VectorXd& command_Pa);
  void Commit() { now_ = proposed_; }

  const Eigen::VectorXd& pressure_Pa() const { return proposed_.pressure_Pa; }  ///< [chambers]
  const Eigen::VectorXd& sensor_noise_Pa() const { return sensor_noise_Pa_; }   ///< [chambers]
  /// The chamber that this supply feeds.
  int ChamberOfSupply(int supply) const { return chamber_of_supply_[At(supply)]; }

 private:
  struct Pressures {
    double t_s = 0.0;
    Eigen::VectorXd supplied_Pa;  ///< [chambers] before the valve
    Eigen::VectorXd pressure_Pa;
  };

  void ApplyEffects(const std::vector<std::string>& names, const std::vector<double>& begins_s,
                    const Effects& effects);
  Eigen::VectorXd Supplied(const Eigen::VectorXd& command_Pa) const;
  double Follow(Eigen::Index chamber, double from_Pa, double u0_Pa, double u1_Pa, double h_s) const;

  std::vector<int> chamber_of_supply_;
  Eigen::VectorXd gain_;  ///< [chambers] as all below
  Eigen::VectorXd zero_Pa_;
  Eigen::VectorXd tau_s_;
  Eigen::VectorXd leak_ratio_;
  Eigen::VectorXd blocked_from_s_;  ///< infinity: never
  Eigen::VectorXd sensor_noise_Pa_;
  Pressures now_;
  Pressures proposed_;
};

}  // namespace palpate::virtual_robot
