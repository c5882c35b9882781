// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/experiment/recording.hpp"
#include "libs/fem/embedding.hpp"

namespace palpate::offline {

/// Refuses the first known load that lies off the body (experiment::RequireOnBody).
void RequireLoadsOnBody(const experiment::Recording& recording, const fem::PointLocator& places);

}  // namespace palpate::offline
