// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

// Parts of the report in HTML; empty where there is nothing to tell.

/// Named causes with their parameters and evidence.
std::string CauseTable(const DiagnosisResult& result);
std::string RivalTable(const DiagnosisResult& result);
std::string ExperimentTable(const DiagnosisResult& result);
std::string RecordingTable(const DiagnosisResult& result);
/// The smallest size of each fault that would be named, and how often a healthy robot would be
/// accused.
std::string FindableTable(const DiagnosisResult& result);
std::string IdentityList(const DiagnosisResult& result);
std::string HowToRepeat(const DiagnosisResult& result);

}  // namespace palpate::diagnosis
