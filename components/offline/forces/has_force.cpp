// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/has_force.hpp"

namespace palpate::offline {

bool HasForce(const force_estimation::ContactForce& contact) {
  switch (contact.status.code()) {
    case StatusCode::kOk:
    case StatusCode::kTangentialUnobservable:
    case StatusCode::kUncertain:
    case StatusCode::kHidden: return true;
    default: return false;
  }
}

}  // namespace palpate::offline
