// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/diagnosis/forward/simulation.hpp"
#include "libs/fem/load_state.hpp"

namespace palpate::diagnosis {

/// All that the tangent and the residual of one robot depend on at a shape. While a command is held
/// samples share it.
struct TangentState {
  double modulus_change = 0.0;  ///< over the time of the experiment
  HistoryVariables history_variables;
  Eigen::VectorXd friction;  ///< [RubbingEyelets] CableFriction::Signed
  fem::StaticState state;

  /// To the last bit.
  bool IsSame(const TangentState& other) const;
};

}  // namespace palpate::diagnosis
