// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/palpate/system/system_file.hpp"
#include "libs/core/config_node.hpp"

namespace palpate::command {

/// Replaces `$(name)` in every text below `root` by the value of the variable: of `given`, else of
/// the map `variables` of the file; `$(dirname)` is the folder of the file. Throws InputError for a
/// variable that has no value, and for one of `given` that the file does not have.
void SubstituteVariables(ConfigNode* root, const SystemVariables& given);

}  // namespace palpate::command
