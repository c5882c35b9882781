// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "tests/system/blind/case_record.hpp"

namespace palpate::blind {

/// What of a case that was run no other file of its folders tells: with it a set that was ended
/// goes on where it was. `how`: the diagnosis was asked. Throws RunError where the file cannot be
/// written.
void KeepRecord(const CaseRecord& record, const std::string& how,
                const std::filesystem::path& file);

/// The same back, into a record of the same seed. False: there is no such file, it was cut short,
/// or the diagnosis was asked otherwise; the record is as it was.
bool ReadKeptRecord(const std::filesystem::path& file, const std::string& how, CaseRecord* record);

}  // namespace palpate::blind
