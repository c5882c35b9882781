// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct LaunchOptions {
  std::filesystem::path system;        ///< file, or name in config/systems
  std::vector<std::string> variables;  ///< "name:=value"
  std::string host;                    ///< empty: the only one, or this computer
  std::vector<std::string> set;        ///< "process.key=value"
  int domain_id = -1;                  ///< -1: that of the file
  bool dry_run = false;
  bool json = false;
};

/// `palpate launch`: starts the processes of one host of a system file and runs until they have
/// ended, or a signal stops them. Returns 0, or 1 where a required process failed. Throws
/// InputError and RunError.
int Launch(const LaunchOptions& options);

app::Verb LaunchVerb();

}  // namespace palpate::command
