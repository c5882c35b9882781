// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <istream>
#include <string>

namespace palpate::command {

/// Asks the user in the terminal; without one every answer is the default.
class Questions {
 public:
  /// `answers`: where lines are read; null: nobody is there. Outlives this.
  explicit Questions(std::istream* answers) : answers_(answers) {}

  bool AsksSomebody() const { return answers_ != nullptr; }

  /// The line that the user types, without blanks around it; `standard` where it is empty, where
  /// the input has ended, or where nobody is there.
  std::string Ask(const std::string& question, const std::string& standard);

  /// Asks until `take` accepts the answer. An InputError of `take` is shown, and asked again;
  /// where the input has ended, or nobody is there, it is thrown.
  void AskUntil(const std::string& question, const std::string& standard,
                const std::function<void(const std::string&)>& take);

 private:
  std::istream* answers_;
};

}  // namespace palpate::command
