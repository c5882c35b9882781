// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/gas_law.hpp"

#include "libs/core/check.hpp"

namespace palpate::robot {

GasLaw::GasLaw(double volume_m3, double dead_volume_m3, double air_m3, double ambient_Pa)
    : volume_m3_(volume_m3 + dead_volume_m3),
      amount_J_(ambient_Pa * (volume_m3_ + air_m3)),
      ambient_Pa_(ambient_Pa) {
  PALPATE_CHECK(volume_m3 > 0.0 && dead_volume_m3 >= 0.0, volume_m3, dead_volume_m3);
  PALPATE_CHECK(amount_J_ > 0.0, amount_J_);
}

double GasLaw::Pressure_Pa(double change_m3) const {
  return amount_J_ / (volume_m3_ + change_m3) - ambient_Pa_;
}

double GasLaw::Change_m3(double pressure_Pa) const {
  return amount_J_ / (ambient_Pa_ + pressure_Pa) - volume_m3_;
}

double GasLaw::Compliance_m3_Pa(double pressure_Pa) const {
  const double absolute_Pa = ambient_Pa_ + pressure_Pa;
  return amount_J_ / (absolute_Pa * absolute_Pa);
}

}  // namespace palpate::robot
