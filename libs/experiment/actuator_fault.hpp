// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/experiment/actuation.hpp"

namespace palpate::experiment {

/// Why no actuator can have this input, in a clause: a tension or a pressure too low, a
/// displacement or a volume too large. Empty: it can.
std::string ActuatorFault(double value, ActuatorQuantity quantity, bool of_chamber);

}  // namespace palpate::experiment
