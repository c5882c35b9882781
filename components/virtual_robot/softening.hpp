// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/virtual_robot/bench_body.hpp"
#include "components/virtual_robot/effects.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/fem/mullins.hpp"

namespace palpate::virtual_robot {

/// What makes the moduli change while the bench runs: temperature, in proportion to time, and
/// mullins, the damage of R. W. Ogden, D. G. Roxburgh (A pseudo-elastic model for the Mullins
/// effect in filled rubber, Proc. R. Soc. Lond. A 455, 1999, with their beta = 0),
///   eta = 1 - erf((W_max - W) / m) / r,
/// W the energy density of the undamaged material, averaged over each cell, and W_max its largest
/// value so far. It follows the strain in steps that are the shorter the more this answers under a
/// given load: several for a state that must be in balance with it, one where states follow each
/// other closely.
class Softening {
 public:
  /// `duration_s` > 0: after which the temperature is at its end. Throws InputError.
  Softening(const BenchBody& body, const Effects& effects, double duration_s);

  bool active() const { return mullins_.has_value() || temperature_change_ != 0.0; }
  bool answers_strain() const { return mullins_.has_value(); }
  const Eigen::VectorXd& factor_of_cell() const { return factor_; }  ///< [cells]

  /// A virgin material at `x_m`, at time 0 of the experiment, and the factors set in `body`.
  void Reset(fem::ElasticBody* body, const Eigen::VectorXd& x_m);
  /// A step of the damage towards what a body at `x_m` asks for, should it come to rest there: its
  /// W_max is that of before. By how much the worst cell's was off.
  double Approach(fem::ElasticBody* body, const Eigen::VectorXd& x_m);
  /// Back to the state of the last Update or Reset.
  void Restore(fem::ElasticBody* body);
  /// The same material at `x_m`, `since_s` after the beginning.
  void Update(fem::ElasticBody* body, const Eigen::VectorXd& x_m, double since_s);

 private:
  double Damage(const fem::ElasticBody& body, const Eigen::VectorXd& x_m,
                Eigen::VectorXd* largest_J_m3);
  void SetFactors(fem::ElasticBody* body);

  std::optional<fem::MullinsLaw> mullins_;
  double temperature_change_ = 0.0;  ///< of the moduli, relative, at the end
  double duration_s_;
  double warmth_ = 1.0;           ///< factor of temperature now
  Eigen::VectorXd volume_m3_;     ///< [cells]
  Eigen::VectorXd damage_;        ///< [cells] eta
  Eigen::VectorXd left_damage_;   ///< [cells] that of the last Update
  Eigen::VectorXd largest_J_m3_;  ///< [cells] W_max
  Eigen::VectorXd factor_;
};

}  // namespace palpate::virtual_robot
