// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>

#include "components/palpate/import/import_options.hpp"
#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate import`: turns a motion-capture file into a recording of an experiment, which is made
/// where it is absent, and reports the quality of the data. All is checked before anything is
/// written; an existing recording is never overwritten. Returns 0; throws InputError and RunError.
int RunImport(const ImportOptions& options, std::ostream& report);

app::Verb ImportVerb();

}  // namespace palpate::command
