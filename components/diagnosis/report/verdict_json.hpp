// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// verdict.json (docs/experiment.md), SI. What is not known is null, and so is `next_experiment`
/// where nothing is left to tell apart. A cause's `where` is a text, or a list where the cause is
/// at several places.
std::string FormatVerdict(const DiagnosisResult& result);

}  // namespace palpate::diagnosis
