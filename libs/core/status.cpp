// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/status.hpp"

#include "libs/core/check.hpp"

namespace palpate {

std::string_view ToString(StatusCode code) {
  switch (code) {
    case StatusCode::kNotRun: return "not_run";
    case StatusCode::kOk: return "ok";
    case StatusCode::kNotConverged: return "not_converged";
    case StatusCode::kBudgetReached: return "budget_reached";
    case StatusCode::kNotPositiveDefinite: return "not_positive_definite";
    case StatusCode::kInverted: return "inverted";
    case StatusCode::kTensionLimit: return "tension_limit";
    case StatusCode::kUnobservable: return "unobservable";
    case StatusCode::kTangentialUnobservable: return "tangential_unobservable";
    case StatusCode::kUncertain: return "uncertain";
    case StatusCode::kNoContact: return "no_contact";
    case StatusCode::kHidden: return "hidden";
    case StatusCode::kNoCalibration: return "no_calibration";
    case StatusCode::kStale: return "stale";
    case StatusCode::kNoRobotSeen: return "no_robot_seen";
    case StatusCode::kInvalidInput: return "invalid_input";
  }
  PALPATE_CHECK(false, static_cast<int>(code));
  return {};
}

}  // namespace palpate
