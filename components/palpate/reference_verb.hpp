// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// The keys of these kinds of files ("robot", "experiment", "recording", "camera", "calibration",
/// "scenario") as Markdown tables or, of one kind, as a JSON Schema. Throws InputError for another
/// kind, and for a schema of several.
std::string Reference(const std::vector<std::string>& kinds, bool as_json_schema);

/// `palpate reference`: prints Reference().
app::Verb ReferenceVerb();

}  // namespace palpate::command
