// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/questions.hpp"

#include <fmt/core.h>

#include <cstdio>

#include "components/palpate/new_robot/points_text.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

std::string Questions::Ask(const std::string& question, const std::string& standard) {
  if (answers_ == nullptr) return standard;
  fmt::print("{}{} ", question, standard.empty() ? ":" : " [" + standard + "]:");
  std::fflush(stdout);
  std::string line;
  if (!std::getline(*answers_, line)) {
    fmt::print("\n");
    answers_ = nullptr;
    return standard;
  }
  const std::string answer = SplitText(line, '\n').front();
  return answer.empty() ? standard : answer;
}

void Questions::AskUntil(const std::string& question, const std::string& standard,
                         const std::function<void(const std::string&)>& take) {
  while (true) {
    const std::string answer = Ask(question, standard);
    try {
      take(answer);
      return;
    } catch (const InputError& error) {
      if (!AsksSomebody()) throw;
      fmt::print("  {}\n", error.what());
    }
  }
}

}  // namespace palpate::command
