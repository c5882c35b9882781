// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_force_estimator.hpp"

namespace palpate::force_estimation {

bool PredictsShape(const ForceEstimate& estimate) {
  switch (estimate.status.code()) {
    case StatusCode::kOk:
    case StatusCode::kNoContact:
    case StatusCode::kNoCalibration:  // while it learns
    case StatusCode::kBudgetReached:  // on the way
    case StatusCode::kNoRobotSeen:    // where the robot would be
      return estimate.x_m.size() > 0 && estimate.x_m.allFinite();
    default: return false;
  }
}

}  // namespace palpate::force_estimation
