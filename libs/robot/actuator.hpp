// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/core/cable_reading.hpp"
#include "libs/fem/scalar_constraint.hpp"

namespace palpate::robot {

enum class ActuatorKind { kCable, kChamber };

/// What drives the body with one number. Its value g(x), m, becomes smaller as it works: the length
/// of a cable, or how far the piston of a chamber is out (chamber.hpp). Its multiplier is the force
/// that does so, N: the tension of a cable, the thrust of a chamber. In all code its displacement
/// counts what g has lost from the undeformed body on.
class Actuator : public fem::ScalarConstraint {
 public:
  /// Of the undeformed body.
  double rest_value_m() const { return rest_value_m_; }
  double Displacement_m(const Eigen::VectorXd& x_m) const { return rest_value_m_ - Value(x_m); }
  /// Elastic compliance between the actuator and the body, m/N, 0 at first: length by which a cable
  /// stretches per N of tension, or what a hose takes in. It is negative where the mesh is softer
  /// than the body at the end of the cable.
  double compliance_m_N() const { return compliance_m_N_; }
  void SetCompliance(double compliance_m_N) { compliance_m_N_ = compliance_m_N; }

 protected:
  void SetRestValue(double rest_value_m) { rest_value_m_ = rest_value_m; }

 private:
  double rest_value_m_ = 0.0;
  double compliance_m_N_ = 0.0;
};

/// What an actuator is called and may do, and how what it reports becomes metres and newtons. A
/// cable reports these. A chamber reports its change of volume, displacement times area, and its
/// pressure above ambient, force over area.
struct ActuatorTraits {
  ActuatorKind kind = ActuatorKind::kCable;
  std::string name;
  double least_force_N = 0.0;
  double most_force_N = 0.0;
  double area_m2 = 1.0;  ///< of a chamber's piston; cables have 1, so that nothing is converted

  bool IsChamber() const { return kind == ActuatorKind::kChamber; }
  double ReportedDisplacement(double displacement_m) const { return displacement_m * area_m2; }
  double ReportedForce(double force_N) const { return force_N / area_m2; }
  double Displacement_m(double reported) const { return reported / area_m2; }
  double Force_N(double reported) const { return reported * area_m2; }
  const char* displacement_unit() const { return IsChamber() ? "m3" : "m"; }
  const char* force_unit() const { return IsChamber() ? "Pa" : "N"; }
  /// "cable north", "chamber tip": how messages name it.
  std::string Title() const { return (IsChamber() ? "chamber " : "cable ") + name; }
};

/// What actuators report, one of `traits` each, as metres and newtons.
void ToPistons(const std::vector<ActuatorTraits>& traits, CableReading* reading);

}  // namespace palpate::robot
