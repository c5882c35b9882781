// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/system/process.hpp"

namespace palpate::blind {

/// Runs `palpate ARGUMENTS`, which writes into `log`; its exit code, nothing after ten minutes.
inline std::optional<int> Palpate(const std::vector<std::string>& arguments,
                                  const std::filesystem::path& log) {
  system_test::Process process("palpate", arguments, log);
  return process.Wait(std::chrono::seconds(600));
}

/// The first `what` in a text, which must have one.
inline void Replace(const std::string& what, const std::string& by, std::string* text) {
  const std::size_t found = text->find(what);
  ASSERT_NE(found, std::string::npos) << what;
  text->replace(found, what.size(), by);
}

}  // namespace palpate::blind
