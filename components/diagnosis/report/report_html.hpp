// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// The report for people (components/diagnosis/README.md): one HTML page that needs no
/// other file, no network and no script, the verdict first, figures as SVG; prints on A4. A figure
/// without data is replaced by a sentence that says so. `view_commands` show the residuals on the
/// moving body, of the robot file and then as diagnosed; empty: there is nothing to show.
std::string FormatReport(const DiagnosisResult& result,
                         const std::vector<std::string>& view_commands = {});

}  // namespace palpate::diagnosis
