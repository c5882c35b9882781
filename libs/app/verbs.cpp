// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/verbs.hpp"

#include <cstdio>
#include <memory>
#include <optional>

#include "libs/app/run_main.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

std::unique_ptr<Arguments> ArgumentsOf(const std::string& program, const Verb& verb) {
  return std::make_unique<Arguments>(program + " " + verb.name, verb.purpose, Scope::kVerb);
}

CommandText Describe(const std::string& program, const std::string& purpose,
                     const std::vector<Verb>& verbs, Scope scope) {
  CommandText text{.name = program,
                   .purpose = purpose,
                   .arguments = CommonArguments(program, scope == Scope::kVerb),
                   .verbs = {}};
  for (const Verb& verb : verbs) text.verbs.push_back({verb.name, verb.purpose});
  return text;
}

/// Of all verbs, and of those of groups.
void AddTexts(const std::string& program, const std::vector<Verb>& verbs,
              std::vector<CommandText>* texts) {
  for (const Verb& verb : verbs) {
    if (!verb.verbs.empty()) {
      const std::string group = program + " " + verb.name;
      texts->push_back(Describe(group, verb.purpose, verb.verbs, Scope::kVerb));
      AddTexts(group, verb.verbs, texts);
      continue;
    }
    const std::unique_ptr<Arguments> arguments = ArgumentsOf(program, verb);
    const Verb::Action targets = verb.declare(*arguments);
    texts->push_back(arguments->Text());
  }
}

std::string Completion(const CommandText& program, const std::vector<Verb>& verbs) {
  std::vector<CommandText> texts;
  AddTexts(program.name, verbs, &texts);
  return FormatBashCompletion(program, texts);
}

/// What is asked of the program and not of a verb; nullopt where a verb is.
std::optional<std::string> Answer(const CommandText& program, const std::vector<Verb>& verbs,
                                  const std::vector<std::string>& words) {
  const std::string& word = words.front();
  if (word == "--help" || word == "-h" || word == "help") return FormatHelp(program);
  if (word == "--version") return VersionLine(program.name);
  if (word == "--man") return FormatManualPage(program);
  if (program.name.find(' ') != std::string::npos) return std::nullopt;
  if (word == "--completion" && words.size() == 2 && words.back() == "bash") {
    return Completion(program, verbs);
  }
  if (word == "--completion=bash") return Completion(program, verbs);
  if (word.starts_with("--completion")) {
    throw InputError("--completion: must be bash; see " + program.name + " --help");
  }
  return std::nullopt;
}

const Verb& FindVerb(const std::string& program, const std::string& name,
                     const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) {
    if (verb.name == name) return verb;
    names.push_back(verb.name);
  }
  throw InputError("unknown verb '" + name + "'" + DidYouMean(name, names) + "; see " + program +
                   " --help");
}

int Run(const std::string& program, const std::string& purpose, const std::vector<Verb>& verbs,
        const std::vector<std::string>& words, Scope scope) {
  if (words.empty()) {
    throw InputError("a verb is missing; see " + program + " --help");
  }
  if (const auto answer = Answer(Describe(program, purpose, verbs, scope), verbs, words)) {
    std::fputs(answer->c_str(), stdout);
    return kExitDone;
  }
  const Verb& verb = FindVerb(program, words.front(), verbs);
  const std::vector<std::string> rest(words.begin() + 1, words.end());
  if (!verb.verbs.empty()) {
    return Run(program + " " + verb.name, verb.purpose, verb.verbs, rest, Scope::kVerb);
  }
  const std::unique_ptr<Arguments> arguments = ArgumentsOf(program, verb);
  const Verb::Action action = verb.declare(*arguments);
  if (!arguments->Parse(rest)) return kExitDone;
  return action();
}

}  // namespace

int RunVerbs(const std::string& program, const std::string& purpose, const std::vector<Verb>& verbs,
             const std::vector<std::string>& words) {
  return Run(program, purpose, verbs, words, Scope::kProgram);
}

}  // namespace palpate::app
