// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "libs/app/command_text.hpp"

namespace palpate::app {

/// The words after the program's name.
std::vector<std::string> CommandLineWords(int argc, const char* const* argv);

enum class Need { kRequired, kOptional };
enum class Scope { kProgram, kVerb };

/// What one program, or one verb of it, takes on the command line. One declaration serves parsing,
/// --help, the manual page (--man) and completion (--completion).
///
/// Options are written "--out FOLDER": the second word stands for the value in these texts. An
/// option that is not given does not change its target. Texts say what an option does and its
/// unit; the range and the default, which is the target's value at the declaration, are added. A
/// target that is empty or out of its range is shown as "default: none", unless the text says what
/// holds "without it". The targets must outlive Parse().
///
/// Names may have a short one: "--window,-w N".
class Arguments {
 public:
  /// `program`: "palpate solve"; `purpose`: an imperative sentence without a full stop.
  Arguments(const std::string& program, const std::string& purpose, Scope scope = Scope::kProgram);
  ~Arguments();
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;

  /// An argument without a name; they are taken in the order of these calls.
  void Positional(const std::string& name, std::filesystem::path* value, const std::string& help,
                  Need need = Need::kRequired);
  void Positional(const std::string& name, std::string* value, const std::string& help,
                  Need need = Need::kRequired);
  /// Any number of them, after the others.
  void Positionals(const std::string& name, std::vector<std::string>* values,
                   const std::string& help, Need need = Need::kRequired);

  void Option(const std::string& name, std::filesystem::path* value, const std::string& help,
              Need need = Need::kOptional);
  void Option(const std::string& name, std::string* value, const std::string& help,
              Need need = Need::kOptional);
  /// A whole number from `min` to `max`.
  void Option(const std::string& name, int* value, int min, int max, const std::string& help,
              Need need = Need::kOptional);
  /// A finite number.
  void Option(const std::string& name, double* value, const std::string& help,
              Need need = Need::kOptional);
  /// One of `choices`, with "did you mean".
  void Choice(const std::string& name, std::string* value, std::vector<std::string> choices,
              const std::string& help, Need need = Need::kOptional);
  /// May be given many times, one value each time.
  void Repeated(const std::string& name, std::vector<std::string>* values, const std::string& help);
  void Flag(const std::string& name, bool* value, const std::string& help);

  /// Values that completion offers for an argument declared above.
  void Suggest(const std::string& name, std::vector<std::string> words);

  bool WasGiven(const std::string& name) const;

  /// Reads the words after the program's name. False: --help, --version, --man or --completion was
  /// asked for and printed, nothing is to be done. Throws InputError for anything it cannot read,
  /// an unknown option with "did you mean".
  bool Parse(const std::vector<std::string>& words);

  /// What was declared, positional arguments first.
  CommandText Text() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::app
