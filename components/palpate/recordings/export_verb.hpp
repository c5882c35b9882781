// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate export`: the messages of an MCAP file as CSV, PNG, PLY or PCD, VTU and PVD.
app::Verb ExportVerb();

}  // namespace palpate::command
