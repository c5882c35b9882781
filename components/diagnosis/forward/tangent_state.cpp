// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/tangent_state.hpp"

namespace palpate::diagnosis {

namespace {

template <typename Matrix>
bool AreSame(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}

}  // namespace

bool TangentState::IsSame(const TangentState& other) const {
  return modulus_change == other.modulus_change &&
         history_variables.scale == other.history_variables.scale &&
         AreSame(history_variables.stress_Pa, other.history_variables.stress_Pa) &&
         AreSame(history_variables.cell_factor, other.history_variables.cell_factor) &&
         AreSame(friction, other.friction) && AreSame(state.x_m, other.state.x_m) &&
         AreSame(state.multipliers_N, other.state.multipliers_N) &&
         AreSame(state.loads.external_force_N, other.state.loads.external_force_N) &&
         AreSame(state.loads.fixed_position_m, other.state.loads.fixed_position_m);
}

}  // namespace palpate::diagnosis
