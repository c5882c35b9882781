// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::command {

/// Runs `palpate WORDS...`; returns the exit code. Throws InputError for a missing or unknown verb
/// or option (with "did you mean"), and what the verbs throw.
int RunCommand(const std::vector<std::string>& words);

}  // namespace palpate::command
