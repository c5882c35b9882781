// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/factor.hpp"

namespace palpate::robot {

Status FactorAt(const fem::StaticState& state, Factor factor, fem::Linearisation* linearisation) {
  if (factor == Factor::kRenew) {
    Status status =
        linearisation->Update(state.x_m, state.multipliers_N, state.loads.external_force_N);
    if (!status.ok()) return status;
  }
  if (linearisation->shifted()) return {StatusCode::kNotPositiveDefinite, "the factor is shifted"};
  return Status::Ok();
}

}  // namespace palpate::robot
