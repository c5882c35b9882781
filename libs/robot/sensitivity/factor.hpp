// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/status.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/load_state.hpp"

namespace palpate::robot {

/// Whether the factor of K must be made, or the one of the model's linearisation is at the state
/// already (as after RobotModel::Solve, with nothing computed since).
enum class Factor { kRenew, kPresent };

/// Makes the factor where it must be made. Not ok where there is none, or only a shifted one.
Status FactorAt(const fem::StaticState& state, Factor factor, fem::Linearisation* linearisation);

}  // namespace palpate::robot
