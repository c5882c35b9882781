// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/command_text.hpp"

namespace palpate::app {

namespace {

/// Splits what bash splits: it takes "--out=a" for three words.
constexpr const char* kBegin = R"(() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local verb='' options='' words='' files=''
  if [[ $word == '=' ]]; then
    word=''
  elif [[ $before == '=' ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)";

constexpr const char* kFindVerb =
    "  if ((COMP_CWORD > 1)) && [[ ${COMP_WORDS[1]} != -* ]]; then verb=${COMP_WORDS[1]}; fi\n";

constexpr const char* kEnd = R"(  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    return
  fi
  # Only a shell that completes knows compopt.
  if [[ $files ]]; then compopt -o filenames 2>/dev/null || true; fi
  mapfile -t COMPREPLY < <(
    compgen -W "$words" -- "$word" || true
    if [[ $files ]]; then compgen -f -- "$word"; fi
  )
}
)";

/// `words` between quotes of the script; those that would have to be escaped are left out.
std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (word.find_first_of(" \t\n'\"\\$`") != std::string::npos) continue;
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

std::string Assignments(const std::string& options, const std::string& words, bool files) {
  return "options='" + options + "' words='" + words + "' files=" + (files ? "yes" : "''") +
         " ;;\n";
}

/// The second word of "topic list", for verbs that have verbs.
std::string FindVerbsBelow(const CommandText& program, const std::vector<CommandText>& verbs) {
  std::string groups;
  for (const CommandText& verb : verbs) {
    if (verb.verbs.empty()) continue;
    groups += (groups.empty() ? "" : "|") + ("'" + verb.name.substr(program.name.size() + 1) + "'");
  }
  if (groups.empty()) return {};
  return "  case $verb in\n    " + groups +
         ") if ((COMP_CWORD > 2)) && [[ ${COMP_WORDS[2]} != -* ]]; then verb+=\" "
         "${COMP_WORDS[2]}\"; fi ;;\n  esac\n";
}

/// The words to offer where neither an option's value nor the verb is expected.
std::string ArgumentsCase(const std::string& verb, const CommandText& command) {
  std::string options;
  std::string words;
  bool files = false;
  for (const VerbText& known : command.verbs) words += (words.empty() ? "" : " ") + known.name;
  for (const ArgumentText& argument : command.arguments) {
    if (argument.IsOption()) {
      options += (options.empty() ? "" : " ") + argument.name;
      continue;
    }
    words += (words.empty() || argument.words.empty() ? "" : " ") + Joined(argument.words);
    files = files || argument.is_path;
  }
  return "    '" + verb + "') " + Assignments(options, words, files);
}

/// The values of each option that takes one.
std::string ValueCases(const std::string& verb, const CommandText& command) {
  std::string cases;
  for (const ArgumentText& argument : command.arguments) {
    if (!argument.IsOption() || argument.value.empty()) continue;
    cases += "    '" + verb + " " + argument.name + "') " +
             Assignments("", Joined(argument.words), argument.is_path);
  }
  return cases;
}

}  // namespace

std::string FormatBashCompletion(const CommandText& program,
                                 const std::vector<CommandText>& verbs) {
  std::string function = "_" + program.name;
  for (char& c : function) {
    if (c == '-') c = '_';
  }
  std::string script = "# bash completion of " + program.name + ", from " + program.name +
                       " --completion bash\n" + function + kBegin;
  if (!verbs.empty()) script += kFindVerb + FindVerbsBelow(program, verbs);
  std::string values = ValueCases("", program);
  script += "  case $verb in\n" + ArgumentsCase("", program);
  for (const CommandText& verb : verbs) {
    const std::string name = verb.name.substr(program.name.size() + 1);
    script += ArgumentsCase(name, verb);
    values += ValueCases(name, verb);
  }
  script += "  esac\n  case \"$verb $before\" in\n" + values + "  esac\n" + kEnd;
  return script + "complete -F " + function + " " + program.name + "\n";
}

}  // namespace palpate::app
