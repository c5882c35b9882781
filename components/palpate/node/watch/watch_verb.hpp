// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct WatchOptions {
  int domain_id = 0;
  std::filesystem::path keystore;  ///< of a secured domain; empty: as the environment has it
  std::vector<std::string> remap;
  std::filesystem::path robot;  ///< says which joints are chambers; empty: as SystemListener
  bool once = false;
  bool json = false;
  double rate_hz = 2.0;    ///< 0.1 to 20
  double timeout_s = 5.0;  ///< of `once`, > 0
};

/// Shows the running system until a signal stops it, or once. Returns the exit code: with `once` 1
/// where no process answers. Throws InputError for numbers out of range, RunError where DDS
/// refuses.
int Watch(const WatchOptions& options);

app::Verb WatchVerb();

}  // namespace palpate::command
