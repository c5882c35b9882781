// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/monitor/system_snapshot.hpp"

namespace palpate::monitor {

/// The snapshot as one JSON object on one line, without a line end. Names end in their unit,
/// numbers that are not known are null, what has sent nothing is null.
std::string SnapshotJson(const SystemSnapshot& snapshot);

}  // namespace palpate::monitor
