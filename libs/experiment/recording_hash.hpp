// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/experiment/recording.hpp"

namespace palpate::experiment {

/// "sha256-<64 hex digits>" over the settings and tables of these recordings.
std::string HashRecordings(const std::vector<const Recording*>& recordings);

}  // namespace palpate::experiment
