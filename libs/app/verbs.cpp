// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/verbs.hpp"

#include <algorithm>
#include <cstdio>

#include "libs/app/run_main.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

void PrintOverview(const std::string& program, const std::string& purpose,
                   const std::vector<Verb>& verbs) {
  std::printf("%s\nUsage: %s VERB [ARGUMENTS]\n\nVerbs:\n", purpose.c_str(), program.c_str());
  size_t width = 0;
  for (const Verb& verb : verbs) width = std::max(width, verb.name.size());
  for (const Verb& verb : verbs) {
    std::printf("  %-*s  %s\n", static_cast<int>(width), verb.name.c_str(), verb.purpose.c_str());
  }
  std::printf("\n%s VERB --help tells what a verb takes.\n", program.c_str());
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

}  // namespace

int RunVerbs(const std::string& program, const std::string& purpose, const std::vector<Verb>& verbs,
             const std::vector<std::string>& words) {
  if (words.empty()) {
    throw InputError("a verb is missing; see " + program + " --help");
  }
  if (words.front() == "--help" || words.front() == "-h" || words.front() == "help") {
    PrintOverview(program, purpose, verbs);
    return kExitDone;
  }
  if (words.front() == "--version") {
    std::printf("%s %s\n", program.c_str(), Version());
    return kExitDone;
  }
  const Verb& verb = FindVerb(program, words.front(), verbs);
  Arguments arguments(program + " " + verb.name, verb.purpose);
  const Verb::Action action = verb.declare(arguments);
  if (!arguments.Parse({words.begin() + 1, words.end()})) return kExitDone;
  return action();
}

}  // namespace palpate::app
