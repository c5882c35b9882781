// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::app {

/// One argument of a program, as --help, the manual page and completion show it.
struct ArgumentText {
  std::string name = {};                ///< "ROBOT", or "--out"
  std::string short_name = {};          ///< "-w" of "--window"; empty: none
  std::string value = {};               ///< placeholder of an option's value; empty: a flag
  std::string help = {};                ///< what it does, with unit, range and default
  std::vector<std::string> words = {};  ///< values that completion offers
  bool is_path = false;                 ///< completion offers files and folders
  bool is_required = false;

  bool IsOption() const { return name.starts_with('-'); }
};

struct VerbText {
  std::string name = {};
  std::string purpose = {};
};

/// A program, or one verb of it ("palpate solve").
struct CommandText {
  std::string name = {};
  std::string purpose = {};  ///< one imperative sentence without a full stop
  std::vector<ArgumentText> arguments = {};
  std::vector<VerbText> verbs = {};  ///< of a program that has verbs
};

/// --help, --version, --man; of a whole program --completion, too.
std::vector<ArgumentText> CommonArguments(const std::string& command, bool is_verb);

/// The answer to --help: at most 80 columns, except for words that are longer.
std::string FormatHelp(const CommandText& command);

/// The answer to --man: a page of section 1 for man(1), in roff with the man macros.
std::string FormatManualPage(const CommandText& command);

/// The answer to --completion bash: a script that completes verbs, options, values and files of
/// `program`. `verbs`: "palpate solve", and of verbs that have verbs these, too: "palpate topic",
/// "palpate topic list".
std::string FormatBashCompletion(const CommandText& program, const std::vector<CommandText>& verbs);

}  // namespace palpate::app
