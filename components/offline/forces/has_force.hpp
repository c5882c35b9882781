// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/force_estimation/force_estimate.hpp"

namespace palpate::offline {

/// Whether the contact's force has a number.
bool HasForce(const force_estimation::ContactForce& contact);

}  // namespace palpate::offline
