// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/gas_inputs.hpp"

#include <algorithm>

#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/interpolate_samples.hpp"

namespace palpate::experiment {

const GasColumn* ActuationWithGas::FindGas(const std::string& chamber) const {
  const auto found = std::find_if(
      gas.begin(), gas.end(), [&](const GasColumn& column) { return column.chamber == chamber; });
  return found == gas.end() ? nullptr : &*found;
}

double ActuationWithGas::AirAt_m3(const GasColumn& column, double now_s) const {
  return InterpolateSamples(actuation.t_s, column.air_m3, now_s);
}

void CheckGas(const ActuationWithGas& inputs, const std::vector<std::string>& cables,
              const std::vector<std::string>& chambers) {
  for (const GasColumn& column : inputs.gas) {
    const std::string& name = column.chamber;
    if (IndexOf(name, cables)) {
      throw InputError(column.where, "'" + name + "' is a cable: it holds no gas");
    }
    if (!IndexOf(name, chambers)) {
      throw InputError(column.where, "the robot has no chamber '" + name + "'" +
                                         DidYouMean(name, chambers) + "; it has " +
                                         (chambers.empty() ? "none" : Listed(chambers)));
    }
    for (const auto quantity : {ActuatorQuantity::kTension, ActuatorQuantity::kDisplacement}) {
      const ActuatorColumn* other = inputs.actuation.Find(name, quantity);
      if (other == nullptr) continue;
      throw InputError(column.where, "chamber '" + name + "' has the column '" + other->Header() +
                                         "', too: give one of them");
    }
  }
}

}  // namespace palpate::experiment
