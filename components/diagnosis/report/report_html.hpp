// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// The report for people (components/diagnosis/README.md): one HTML page that needs no
/// other file, no network and no script, the verdict first, figures as SVG; prints on A4. A figure
/// without data is replaced by a sentence that says so.
std::string FormatReport(const DiagnosisResult& result);

}  // namespace palpate::diagnosis
