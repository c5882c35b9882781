// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_force_estimator.hpp"

namespace palpate::force_estimation {

bool PredictsShape(const ForceEstimate& estimate) {
  switch (estimate.status.code()) {
    case StatusCode::kOk:
    case StatusCode::kNoContact:
    case StatusCode::kUnobservable:   // the fitted shape, with a force of unknown place
    case StatusCode::kNoCalibration:  // during the calibration frames
    case StatusCode::kBudgetReached:  // before convergence
    case StatusCode::kNoRobotSeen:    // the predicted shape
      return estimate.x_m.size() > 0 && estimate.x_m.allFinite();
    default: return false;
  }
}

}  // namespace palpate::force_estimation
