// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct SecurityOptions {
  std::string action;  ///< init, enroll, revoke, check
  std::filesystem::path keystore;
  std::vector<std::string> names;  ///< NAME[=ROLE][@HOST]
  std::filesystem::path system;    ///< system file; empty: none
  int days = 730;                  ///< for which identities hold
  std::string node_namespace;      ///< of `names`; empty: /
  std::vector<std::string> remap;  ///< of `names`
  std::vector<std::string> hosts;  ///< HOST=PATH, to compare with
  bool json = false;
};

/// `palpate security`: makes, extends, changes or checks the keystore of a secured system. Returns
/// the exit code: 1 where `check` finds an error. Throws InputError and RunError.
int Security(const SecurityOptions& options);

app::Verb SecurityVerb();

}  // namespace palpate::command
