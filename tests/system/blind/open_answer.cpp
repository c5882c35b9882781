// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/open_answer.hpp"

#include <nlohmann/json.hpp>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/system/process.hpp"

namespace palpate::blind {

std::vector<scenario::ActiveEffect> OpenAnswer(const std::filesystem::path& experiment,
                                               const std::filesystem::path& answer) {
  std::filesystem::path log = answer;
  log += ".check.log";
  const auto done = system_test::RunProgram(
      "palpate", {"simulate", "--check", experiment.string(), "--answer", answer.string()}, log);
  if (done != 0) throw RunError("the seal is broken: " + ReadFile(log));
  std::vector<scenario::ActiveEffect> effects;
  const auto json = nlohmann::json::parse(ReadFile(answer));
  for (const auto& effect : json.at("effects")) {
    effects.push_back({.id = effect.at("id"),
                       .where = effect.at("where"),
                       .parameters = effect.at("parameters")});
  }
  return effects;
}

}  // namespace palpate::blind
