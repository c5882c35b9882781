// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cstdlib>

#include "libs/app/arguments.hpp"
#include "libs/app/node_options.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/verbs.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Words = std::vector<std::string>;

struct SolveArguments {
  std::filesystem::path robot;
  std::filesystem::path out;
  std::string what = "material";
  std::vector<std::string> extra;
  int seed = 1;
  double scale = 2.0;
  bool verbose = false;

  void Declare(Arguments& arguments) {
    arguments.Positional("robot", &robot, "Robot file");
    arguments.Option("--out", &out, "Folder", Need::kRequired);
    arguments.Choice("--what", &what, {"material", "camera"}, "What is found");
    arguments.Repeated("--extra", &extra, "More");
    arguments.Option("--seed", &seed, 0, 99, "Seed");
    arguments.Option("--scale", &scale, "Scale");
    arguments.Flag("--verbose", &verbose, "Say more");
  }
  bool Parse(const Words& words) {
    Arguments arguments("palpate solve", "Solves.");
    Declare(arguments);
    return arguments.Parse(words);
  }
};

std::string ProgramRefusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string RefusalOf(const Words& words) {
  return ProgramRefusal([&] { SolveArguments().Parse(words); });
}

TEST(Arguments, ReadsPositionalsOptionsAndFlags) {
  SolveArguments read;
  EXPECT_TRUE(read.Parse({"a.yaml", "--out", "dir", "--what=camera", "--seed", "7", "--scale",
                          "-1e-3", "--verbose", "--extra", "x=1", "--extra", "y=2"}));
  EXPECT_EQ(read.robot, "a.yaml");
  EXPECT_EQ(read.out, "dir");
  EXPECT_EQ(read.what, "camera");
  EXPECT_EQ(read.seed, 7);
  EXPECT_EQ(read.scale, -1e-3);
  EXPECT_TRUE(read.verbose);
  EXPECT_THAT(read.extra, ElementsAre("x=1", "y=2"));
}

TEST(Arguments, ARepeatedOptionTakesOneValueEachTime) {
  SolveArguments read;
  EXPECT_TRUE(read.Parse({"--extra", "x=1", "a.yaml", "--out", "dir"}));
  EXPECT_EQ(read.robot, "a.yaml");
  EXPECT_THAT(read.extra, ElementsAre("x=1"));
  EXPECT_TRUE(read.Parse({"--extra", "[1,2]", "--extra=-3", "b.yaml", "--out", "dir"}));
  EXPECT_EQ(read.robot, "b.yaml");
  EXPECT_THAT(read.extra, ElementsAre("[1,2]", "-3"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out", "dir", "--extra", "x", "y"}),
              HasSubstr("unexpected argument 'y'"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out", "dir", "--extra"}), HasSubstr("--extra"));
}

TEST(Arguments, PositionalsTakeWhatIsLeft) {
  std::vector<std::string> extra;
  std::vector<std::string> addresses;
  Arguments arguments("palpate capture", "List");
  arguments.Repeated("--extra", &extra, "More");
  arguments.Positionals("ADDRESS", &addresses, "Addresses", Need::kOptional);
  EXPECT_TRUE(arguments.Parse({"1.1.1.1", "--extra", "x", "2.2.2.2", "3.3.3.3"}));
  EXPECT_THAT(extra, ElementsAre("x"));
  EXPECT_THAT(addresses, ElementsAre("1.1.1.1", "2.2.2.2", "3.3.3.3"));
}

TEST(Arguments, WhatIsNotGivenKeepsItsValue) {
  SolveArguments read;
  EXPECT_TRUE(read.Parse({"a.yaml", "--out", "dir"}));
  EXPECT_EQ(read.what, "material");
  EXPECT_EQ(read.seed, 1);
  EXPECT_FALSE(read.verbose);
}

TEST(Arguments, RefusalsNameWordAndRemedy) {
  EXPECT_EQ(RefusalOf({"a.yaml", "--uot", "dir"}),
            "unknown option '--uot' (did you mean '--out'?); see palpate solve --help");
  EXPECT_THAT(RefusalOf({"--out", "dir"}), HasSubstr("robot is required"));
  EXPECT_THAT(RefusalOf({"a.yaml"}), HasSubstr("--out is required"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out"}), HasSubstr("--out"));
  EXPECT_THAT(RefusalOf({"a.yaml", "b.yaml", "--out", "dir"}),
              HasSubstr("unexpected argument 'b.yaml'"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out", "d", "--seed", "100"}), HasSubstr("from 0 to 99"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out", "d", "--seed", "1.5"}), HasSubstr("from 0 to 99"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out", "d", "--scale", "nan"}), HasSubstr("finite"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out", "d", "--scale", "0x10"}), HasSubstr("finite"));
  EXPECT_THAT(RefusalOf({"a.yaml", "--out", "d", "--what", "materiel"}),
              HasSubstr("did you mean 'material'?"));
}

TEST(Arguments, HelpAndVersionEndTheProgram) {
  ::testing::internal::CaptureStdout();
  EXPECT_FALSE(SolveArguments().Parse({"--help"}));
  EXPECT_FALSE(SolveArguments().Parse({"--version"}));
  const std::string printed = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(printed, HasSubstr("Solves."));
  EXPECT_THAT(printed, HasSubstr("--what"));
  EXPECT_THAT(printed, HasSubstr(std::string("palpate solve ") + Version() + "\n"));
}

std::vector<Verb> TwoVerbs() {
  const auto declare_solve = [](Arguments& arguments) -> Verb::Action {
    auto read = std::make_shared<SolveArguments>();
    read->Declare(arguments);
    return [read] { return read->seed; };
  };
  const auto declare_info = [](Arguments&) -> Verb::Action { return [] { return 0; }; };
  return {{"solve", "Solves.", declare_solve}, {"info", "Tells.", declare_info}};
}

TEST(Verbs, RunsTheNamedOneWithItsArguments) {
  EXPECT_EQ(RunVerbs("palpate", "Feels.", TwoVerbs(), {"solve", "a", "--out=b", "--seed=42"}), 42);
}

TEST(Verbs, RefusesUnknownAndMissingOnes) {
  EXPECT_EQ(ProgramRefusal([] { RunVerbs("palpate", "Feels.", TwoVerbs(), {"slove"}); }),
            "unknown verb 'slove' (did you mean 'solve'?); see palpate --help");
  EXPECT_EQ(ProgramRefusal([] { RunVerbs("palpate", "Feels.", TwoVerbs(), {}); }),
            "a verb is missing; see palpate --help");
}

/// A group of verbs beside a verb.
std::vector<Verb> VerbsWithGroup() {
  std::vector<Verb> verbs = TwoVerbs();
  verbs.push_back({.name = "topic", .purpose = "Looks at topics.", .verbs = TwoVerbs()});
  return verbs;
}

TEST(Verbs, OfAGroupRunAndAreRefusedAsOthers) {
  EXPECT_EQ(RunVerbs("palpate", "Feels.", VerbsWithGroup(),
                     {"topic", "solve", "a", "--out=b", "--seed=42"}),
            42);
  EXPECT_EQ(ProgramRefusal([] {
              RunVerbs("palpate", "Feels.", VerbsWithGroup(), {"topic", "slove"});
            }),
            "unknown verb 'slove' (did you mean 'solve'?); see palpate topic --help");
  EXPECT_EQ(ProgramRefusal([] { RunVerbs("palpate", "Feels.", VerbsWithGroup(), {"topic"}); }),
            "a verb is missing; see palpate topic --help");
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(RunVerbs("palpate", "Feels.", VerbsWithGroup(), {"topic", "--help"}), kExitDone);
  EXPECT_EQ(RunVerbs("palpate", "Feels.", VerbsWithGroup(), {"--completion", "bash"}), kExitDone);
  const std::string printed = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(printed, HasSubstr("palpate topic VERB --help lists the arguments of a verb."));
  EXPECT_THAT(printed, HasSubstr("    'topic solve') options="));
}

TEST(Verbs, HelpListsThem) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(RunVerbs("palpate", "Feels.", TwoVerbs(), {"--help"}), kExitDone);
  EXPECT_EQ(RunVerbs("palpate", "Feels.", TwoVerbs(), {"--version"}), kExitDone);
  EXPECT_EQ(RunVerbs("palpate", "Feels.", TwoVerbs(), {"solve", "--help"}), kExitDone);
  const std::string printed = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(printed, HasSubstr("  solve                   Solves.\n"
                                 "  info                    Tells.\n"));
  EXPECT_THAT(printed, HasSubstr(std::string("palpate ") + Version()));
}

TEST(RunMain, MapsErrorsToExitCodesAndOneLine) {
  const auto run = [](const std::function<int()>& work, std::string* printed) {
    ::testing::internal::CaptureStderr();
    const int exit_code = RunMain("palpate", work);
    *printed = ::testing::internal::GetCapturedStderr();
    return exit_code;
  };
  std::string printed;
  EXPECT_EQ(run([] { return 0; }, &printed), 0);
  EXPECT_EQ(printed, "");
  EXPECT_EQ(run([] { return 1; }, &printed), 1);
  EXPECT_EQ(run([]() -> int { throw InputError({"a.yaml", 2, 1}, "bad\nvalue\n"); }, &printed), 2);
  EXPECT_EQ(printed, "palpate: error: a.yaml:2:1: bad value\n");
  EXPECT_EQ(run([]() -> int { throw RunError("disk full"); }, &printed), 1);
  EXPECT_EQ(printed, "palpate: error: disk full\n");
  EXPECT_EQ(run([]() -> int { throw RunError("no fit:\n  1. unit"); }, &printed), 1);
  EXPECT_EQ(printed, "palpate: error: no fit:\n  1. unit\n");
  EXPECT_EQ(run([]() -> int { throw std::logic_error("odd"); }, &printed), 1);
  EXPECT_EQ(run([]() -> int { throw std::bad_alloc(); }, &printed), 1);
  EXPECT_EQ(printed, "palpate: error: out of memory\n");
  EXPECT_EQ(run([]() -> int { throw Interrupted("after 2 of 3 rows: kept"); }, &printed), 130);
  EXPECT_EQ(printed, "palpate: interrupted after 2 of 3 rows: kept\n");
}

TEST(RunMainDeathTest, OutputThatCannotBeWrittenIsAFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const auto print_to_full_disk = [] {
    if (std::freopen("/dev/full", "w", stdout) == nullptr) return 99;
    return RunMain("palpate", [] {
      std::printf("text\n");
      return 0;
    });
  };
  EXPECT_EXIT(std::_Exit(print_to_full_disk()), ::testing::ExitedWithCode(1),
              "palpate: error: standard output could not be written: No space left");
}

struct Config {
  int count = 51;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("count", count, {.min = 1.0}, "How many");
  }
};

/// Reads the command line of a node with ROS_DOMAIN_ID set to `domain` ("" for unset).
class NodeOptionsTest : public ::testing::Test {
 protected:
  NodeOptionsTest() { unsetenv("ROS_DOMAIN_ID"); }

  bool Read(const Words& words) {
    std::vector<const char*> argv{"palpate-x"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    command_ = {};
    Arguments arguments("palpate-x", "Does.");
    return ReadNodeCommand(arguments, static_cast<int>(argv.size()), argv.data(), &command_);
  }
  std::string RefusalOf(const Words& words) {
    return ProgramRefusal([&] { Read(words); });
  }

  NodeCommand<Config> command_;
  const Config& config_ = command_.config;
  const NodeOptions& options_ = command_.options;
};

TEST_F(NodeOptionsTest, TheCommandLineWinsOverTheFileAndTheFileOverTheDefault) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("palpate_node_options_test_" + std::to_string(::getpid()) + ".yaml");
  WriteFile(file, "count: 7\n");
  EXPECT_TRUE(Read({}));
  EXPECT_EQ(config_.count, 51);
  EXPECT_TRUE(Read({"--config", file.string()}));
  EXPECT_EQ(config_.count, 7);
  EXPECT_EQ(options_.config_sha256.size(), 64u);
  EXPECT_TRUE(Read({"--set", "count=8", "--config", file.string(), "--set", "count=9"}));
  EXPECT_EQ(config_.count, 9);
  std::filesystem::remove(file);
}

TEST_F(NodeOptionsTest, TheDomainIsGivenElseOfTheEnvironmentElseZero) {
  EXPECT_TRUE(Read({}));
  EXPECT_EQ(options_.domain_id, 0);
  setenv("ROS_DOMAIN_ID", "42", 1);
  EXPECT_TRUE(Read({}));
  EXPECT_EQ(options_.domain_id, 42);
  EXPECT_TRUE(Read({"--domain", "7"}));
  EXPECT_EQ(options_.domain_id, 7);
}

TEST_F(NodeOptionsTest, RefusesDomainsThatDoNotExist) {
  EXPECT_THAT(RefusalOf({"--domain", "233"}), HasSubstr("from 0 to 232"));
  EXPECT_THAT(RefusalOf({"--domain", "-1"}), HasSubstr("from 0 to 232"));
  for (const char* text : {"233", "-1", "x", "1 "}) {
    setenv("ROS_DOMAIN_ID", text, 1);
    EXPECT_THAT(RefusalOf({}), HasSubstr("ROS_DOMAIN_ID: must be 0 to 232")) << text;
  }
}

TEST_F(NodeOptionsTest, RefusesBadSettingsFilesAndLevels) {
  EXPECT_THAT(RefusalOf({"--set", "count=0"}), HasSubstr("must be 1 to"));
  EXPECT_THAT(RefusalOf({"--config", "/nowhere.yaml"}), HasSubstr("No such file"));
  EXPECT_THAT(RefusalOf({"--log-level", "inof"}), HasSubstr("did you mean 'info'?"));
  EXPECT_THAT(RefusalOf({"--markdown"}), HasSubstr("needs --print-config"));
}

TEST_F(NodeOptionsTest, PrintsTheSettledSettingsAndEnds) {
  ::testing::internal::CaptureStdout();
  EXPECT_FALSE(Read({"--print-config", "--set", "count=5"}));
  EXPECT_FALSE(Read({"--print-config", "--markdown"}));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(),
            "# How many (>= 1)\ncount: 5\n"
            "| parameter | default | range | meaning |\n|---|---|---|---|\n"
            "| `count` | `51` | >= 1 | How many |\n");
}

}  // namespace
}  // namespace palpate::app
