// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "libs/app/arguments.hpp"

namespace palpate::app {

/// One verb of a command ("palpate solve"), or a group of them ("palpate topic").
struct Verb {
  /// Does the work after the arguments were read; returns the exit code.
  using Action = std::function<int()>;

  std::string name;
  std::string purpose;  ///< an imperative sentence without a full stop, for both helps
  /// Declares the verb's arguments, whose targets the returned action owns (shared_ptr).
  std::function<Action(Arguments&)> declare = {};
  std::vector<Verb> verbs = {};  ///< of a group, which has no `declare`: "list" of "palpate topic"
};

/// Runs the verb that words[0] names with the rest of the words (those after the program's name);
/// --help, --version, --man and --completion of the program, and those of a group, are answered
/// here. Throws InputError
/// for a missing verb or an unknown one, with "did you mean".
int RunVerbs(const std::string& program, const std::string& purpose, const std::vector<Verb>& verbs,
             const std::vector<std::string>& words);

}  // namespace palpate::app
