// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::robot {

/// The pressure of the air round the robot, Pa, absolute.
inline constexpr double kAmbient_Pa = 101325.0;

/// Gas in a closed chamber and its tube, at a constant temperature (Boyle):
/// (p_ambient + p) (V0 + dV + V_dead) = p_ambient (V0 + V_dead + air). The pressure p counts from
/// ambient, the change of volume dV from the undeformed chamber, and `air`, the volume at ambient
/// pressure of what was pumped in, from the undeformed chamber full of air at ambient pressure.
/// With a large tube the law holds the pressure, p = p_ambient air / V_dead; a fluid that does not
/// yield, p_ambient going to infinity, holds the volume, dV = air.
class GasLaw {
 public:
  /// `volume_m3` of the undeformed chamber, > 0; `dead_volume_m3` of the tube, >= 0; more `air_m3`
  /// than -(volume_m3 + dead_volume_m3), which would be a vacuum.
  GasLaw(double volume_m3, double dead_volume_m3, double air_m3, double ambient_Pa = kAmbient_Pa);

  /// At this change of volume, which leaves some.
  double Pressure_Pa(double change_m3) const;
  /// At this pressure above ambient, which is more than a vacuum.
  double Change_m3(double pressure_Pa) const;
  /// -d(Change_m3)/dp > 0.
  double Compliance_m3_Pa(double pressure_Pa) const;
  double ambient_Pa() const { return ambient_Pa_; }
  /// Of the undeformed chamber and its tube, m3.
  double volume_m3() const { return volume_m3_; }

 private:
  double volume_m3_;
  double amount_J_;  ///< absolute pressure times volume
  double ambient_Pa_;
};

}  // namespace palpate::robot
