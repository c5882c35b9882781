// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "libs/app/child_process.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

namespace fs = std::filesystem;

const fs::path kPrograms = fs::path(PALPATE_BINARY_DIR) / "bin";
/// All processes.
std::vector<std::string> Processes() {
  std::vector<std::string> names;
  std::istringstream list(PALPATE_PROGRAMS);
  for (std::string name; list >> name;) names.push_back(name);
  return names;
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The manual pages and completions of the real programs, as `ninja manuals` writes them.
class Manuals : public testing::Test {
 protected:
  Manuals() {
    std::string command = "cd " + kPrograms.string() +
                          " && " PALPATE_SOURCE_DIR "/cmake/write_manuals.sh " +
                          (folder_ / "share").string() + " palpate";
    for (const std::string& process : Processes()) command += " " + process;
    EXPECT_EQ(Bash(command), "");
  }

  /// What bash prints.
  std::string Bash(const std::string& command) const {
    app::ChildProcess bash("/bin/bash", {"-c", command}, {}, folder_ / "log");
    const int exit_code = bash.Wait();
    const std::string output = ReadFile(folder_ / "log");
    EXPECT_EQ(exit_code, 0) << command << "\n" << output;
    return output;
  }

  std::vector<std::string> Complete(const std::string& program, const std::string& words) const {
    std::string function = "_" + program;
    std::replace(function.begin(), function.end(), '-', '_');
    return LinesOf(Bash("source " + (folder_ / "share/bash-completion/completions").string() + "/" +
                        program + "; COMP_WORDS=(" + program + " " + words +
                        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); " + function +
                        "; printf '%s\\n' \"${COMPREPLY[@]}\""));
  }

  std::vector<std::string> Verbs() const { return Complete("palpate", "''"); }

  /// The options that --help lists.
  std::vector<std::string> OptionsOf(const std::string& command) const {
    static const std::regex kOption("^  (--[A-Za-z0-9-]+).*");
    std::vector<std::string> options;
    for (const std::string& line : LinesOf(Bash(kPrograms.string() + "/" + command + " --help"))) {
      std::smatch match;
      if (std::regex_match(line, match, kOption)) options.push_back(match[1]);
    }
    return options;
  }

  /// Of a verb: a program of its name has the name with a hyphen.
  static std::string PageOf(const std::string& verb) {
    const std::vector<std::string> programs = Processes();
    const bool taken = std::count(programs.begin(), programs.end(), "palpate-" + verb) > 0;
    return (taken ? "palpate_" : "palpate-") + verb;
  }

  fs::path Page(const std::string& name) const {
    return folder_ / "share/man/man1" / (name + ".1");
  }

  /// The page and the completion know exactly the options of --help.
  void ExpectSameOptions(const std::string& command, const std::string& page,
                         const std::vector<std::string>& completed) const {
    const std::vector<std::string> options = OptionsOf(command);
    EXPECT_THAT(options, testing::Contains("--version")) << command;
    EXPECT_EQ(completed, options) << command;
    std::vector<std::string> of_page;
    for (const std::string& line : LinesOf(ReadFile(Page(page)))) {
      static const std::regex kOption(R"(^\\fB(\\-\\-[A-Za-z0-9\\-]+)\\fR.*)");
      std::smatch match;
      if (!std::regex_match(line, match, kOption)) continue;
      of_page.push_back(std::regex_replace(match[1].str(), std::regex(R"(\\-)"), "-"));
    }
    EXPECT_EQ(of_page, options) << command;
  }

  TestFolder folder_;
};

TEST_F(Manuals, KnowTheOptionsOfHelp) {
  ExpectSameOptions("palpate", "palpate", Complete("palpate", "--"));
  EXPECT_THAT(Verbs(), testing::Contains("estimate"));
  for (const std::string& verb : Verbs()) {
    ExpectSameOptions("palpate " + verb, PageOf(verb), Complete("palpate", verb + " --"));
  }
  for (const std::string group : {"topic", "node", "param"}) {
    const std::vector<std::string> verbs = Complete("palpate", group + " ''");
    EXPECT_THAT(verbs, testing::Contains("list"));
    for (const std::string& verb : verbs) {
      ExpectSameOptions("palpate " + group + " " + verb, "palpate-" + group + "-" + verb,
                        Complete("palpate", group + " " + verb + " --"));
    }
  }
  for (const std::string& process : Processes()) {
    ExpectSameOptions(process, process, Complete(process, "--"));
  }
}

TEST_F(Manuals, HaveNoWarningsOfGroff) {
  if (!fs::exists("/usr/bin/groff")) GTEST_SKIP() << "groff is not installed";
  EXPECT_EQ(Bash("groff -man -Tutf8 -ww -z " + (folder_ / "share/man/man1").string() + "/*.1"), "");
}

TEST_F(Manuals, CompleteRobotsAndCauses) {
  EXPECT_THAT(Complete("palpate", "solve four"), testing::ElementsAre("four_leg"));
  EXPECT_THAT(Complete("palpate", "demo --robot = four"), testing::ElementsAre("four_leg"));
  EXPECT_THAT(Complete("palpate", "diagnose rod --exclude cable_fr"),
              testing::ElementsAre("cable_friction"));
}

}  // namespace
}  // namespace palpate::command
