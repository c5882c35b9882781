// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::command {

enum class Grade { kOk, kWarning, kFailure };

/// "ok", "warn", "fail".
std::string_view ToString(Grade grade);

/// What `palpate doctor` found about one thing.
struct Check {
  std::string name;  ///< "receive buffers"
  Grade grade = Grade::kFailure;
  std::string finding;  ///< with the figure that decides
  std::string remedy;   ///< a command where one helps; empty: nothing to do
};

/// A line for each check, and one with their number; `in_color`: for a terminal.
std::string ChecksText(const std::vector<Check>& checks, bool in_color);
/// {"grade": ..., "checks": [{"name", "grade", "finding", "remedy"}]}
std::string ChecksJson(const std::vector<Check>& checks);

/// The worst of them; kOk where there is none.
Grade Worst(const std::vector<Check>& checks);

}  // namespace palpate::command
