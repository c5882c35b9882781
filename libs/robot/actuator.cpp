// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/actuator.hpp"

#include "libs/core/check.hpp"

namespace palpate::robot {

void ToPistons(const std::vector<ActuatorTraits>& traits, CableReading* reading) {
  PALPATE_CHECK(traits.size() == reading->cables.size(), traits.size(), reading->cables.size());
  for (std::size_t a = 0; a < traits.size(); ++a) {
    CableReading::Inputs& inputs = reading->cables[a];
    if (inputs.displacement_m) {
      inputs.displacement_m = traits[a].Displacement_m(*inputs.displacement_m);
    }
    if (inputs.tension_N) inputs.tension_N = traits[a].Force_N(*inputs.tension_N);
  }
}

}  // namespace palpate::robot
