// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct RepairOptions {
  std::filesystem::path file;
  std::filesystem::path out;  ///< empty: the file's name with "_repaired"
  bool json = false;
};

/// `palpate repair`: what is whole of a cut or damaged MCAP file, with index and statistics, as a
/// new file. Throws InputError, RunError.
int Repair(const RepairOptions& options);

app::Verb RepairVerb();

}  // namespace palpate::command
