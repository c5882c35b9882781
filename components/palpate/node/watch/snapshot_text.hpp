// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/monitor/system_snapshot.hpp"

namespace palpate::command {

/// The snapshot for a person: forces first, then what they rest on, then the processes. Lines of
/// text, each with its line end.
std::string SnapshotText(const monitor::SystemSnapshot& snapshot);

}  // namespace palpate::command
