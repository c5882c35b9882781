// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/enclosed_volume.hpp"
#include "libs/robot/actuator.hpp"

namespace palpate::robot {

/// Absolute pressure has a lowest value: a chamber can be sucked to this far below ambient.
inline constexpr double kVacuum_Pa = -101325.0;

/// A closed chamber under pressure, as the piston of area A that does the same work: with the
/// volume V of the chamber, its value is -V / A, its displacement the change of volume over A, and
/// its multiplier, the thrust, is p A. So a chamber has metres and newtons as cables have them, and
/// all solvers treat both alike; A only scales. It can push, and pull as far as to a vacuum.
class Chamber final : public Actuator {
 public:
  /// `wall` closed, its volume above 0 at `rest_x_m` [3n].
  Chamber(fem::MovingSurface wall, const Eigen::VectorXd& rest_x_m);

  /// A = V^(2/3) of the undeformed chamber.
  double area_m2() const { return area_m2_; }
  double Volume_m3(const Eigen::VectorXd& x_m) const { return volume_.Volume_m3(x_m); }
  const fem::MovingSurface& wall() const { return volume_.surface(); }

  double Value(const Eigen::VectorXd& x_m) const override;
  void AddGradient(const Eigen::VectorXd& x_m, double factor,
                   Eigen::VectorXd& nodal) const override;
  fem::NodePairs CoupledPairs() const override { return volume_.CoupledPairs(); }
  void BindTo(const fem::StiffnessMatrix& stiffness) override { volume_.BindTo(stiffness); }
  void AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                    fem::StiffnessMatrix& stiffness) const override;

 private:
  fem::EnclosedVolume volume_;
  double area_m2_ = 1.0;
};

/// The area of the piston that stands for a chamber of this volume at rest.
double PistonArea_m2(double volume_m3);

}  // namespace palpate::robot
