// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/command_text.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>

#include "libs/app/run_main.hpp"
#include "libs/app/verbs.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::app {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

using Words = std::vector<std::string>;

/// A verb with every kind of argument.
struct Options {
  std::filesystem::path robot;
  std::filesystem::path out;
  std::string what = "material";
  std::vector<std::string> recordings;
  std::string notes;
  int samples = 120;
  int domain = -1;
  double sigma_m = 0.002;
  bool json = false;

  void Declare(Arguments& arguments) {
    arguments.Option("--out FOLDER", &out, "Folder of the results", Need::kRequired);
    arguments.Choice("--what", &what, {"material", "camera"}, "What to estimate");
    arguments.Repeated("--recording NAME", &recordings, "Use this recording");
    arguments.Option("--notes", &notes, "Text to store");
    arguments.Option("--samples", &samples, 10, 2000, "Number of samples");
    arguments.Option("--domain", &domain, 0, 232, "DDS domain; without it 0");
    arguments.Option("--sigma M", &sigma_m, "Standard deviation, m");
    arguments.Flag("--json", &json, "Print JSON");
    robot = "four_leg";
    arguments.Positional("ROBOT", &robot, "Robot file");
    arguments.Suggest("ROBOT", {"beam", "four_leg"});
  }
};

std::vector<Verb> SolveAndInfo() {
  const auto declare_solve = [](Arguments& arguments) -> Verb::Action {
    auto options = std::make_shared<Options>();
    options->Declare(arguments);
    return [options] { return 0; };
  };
  const auto declare_info = [](Arguments&) -> Verb::Action { return [] { return 0; }; };
  return {{"solve", "Solve a model", declare_solve}, {"info", "Summarise it", declare_info}};
}

/// What the program prints.
std::string Output(const Words& words) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(RunVerbs("palpate", "Estimate forces", SolveAndInfo(), words), kExitDone);
  return ::testing::internal::GetCapturedStdout();
}

/// Standard output and error of a shell command.
std::string Shell(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>&1").c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe.get())) {
    text.append(part.data(), size);
  }
  return text;
}

/// A script of the program in a file, and what bash completes with it.
class BashTest : public ::testing::Test {
 protected:
  explicit BashTest(const std::string& script = Output({"--completion", "bash"})) {
    std::filesystem::create_directories(folder_);
    WriteFile(folder_ / "completion.bash", script);
    WriteFile(folder_ / "forces one.csv", "");
    std::filesystem::create_directory(folder_ / "experiment");
  }
  ~BashTest() override { std::filesystem::remove_all(folder_); }

  /// As after the words and the tabulator key; bash makes `words` of what was typed.
  Words Complete(const Words& words, const std::string& function = "_palpate") const {
    std::string list;
    for (const std::string& word : words) list += "'" + word + "' ";
    std::istringstream output(Shell(
        "cd '" + folder_.string() + "' && bash --norc -euc \"source completion.bash; COMP_WORDS=(" +
        list + "); COMP_CWORD=" + std::to_string(words.size() - 1) + "; " + function +
        "; printf '%s\\n' \\\"\\${COMPREPLY[@]}\\\"\""));
    Words replies;
    for (std::string reply; std::getline(output, reply);) {
      if (!reply.empty()) replies.push_back(reply);
    }
    return replies;
  }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  ("palpate_completion_test_" + std::to_string(::getpid()));
};

TEST_F(BashTest, CompletesVerbs) {
  EXPECT_THAT(Complete({"palpate", ""}), ElementsAre("solve", "info"));
  EXPECT_THAT(Complete({"palpate", "so"}), ElementsAre("solve"));
}

TEST_F(BashTest, CompletesOptionsOfTheProgramAndOfTheVerb) {
  EXPECT_THAT(Complete({"palpate", "--"}),
              ElementsAre("--help", "--version", "--man", "--completion"));
  EXPECT_THAT(Complete({"palpate", "solve", "--s"}), ElementsAre("--samples", "--sigma"));
  EXPECT_THAT(Complete({"palpate", "info", "--s"}), IsEmpty());
}

TEST_F(BashTest, CompletesNamesAndFilesOfAPositional) {
  EXPECT_THAT(Complete({"palpate", "solve", "four"}), ElementsAre("four_leg"));
  EXPECT_THAT(Complete({"palpate", "solve", "--json", "f"}),
              UnorderedElementsAre("four_leg", "forces one.csv"));
  EXPECT_THAT(Complete({"palpate", "info", ""}), IsEmpty());
}

TEST_F(BashTest, CompletesValuesOfOptions) {
  EXPECT_THAT(Complete({"palpate", "solve", "--what", ""}), ElementsAre("material", "camera"));
  EXPECT_THAT(Complete({"palpate", "solve", "--out", "exp"}), ElementsAre("experiment"));
  EXPECT_THAT(Complete({"palpate", "solve", "--samples", ""}), IsEmpty());
  EXPECT_THAT(Complete({"palpate", "--completion", ""}), ElementsAre("bash"));
}

TEST_F(BashTest, CompletesValuesAfterASignOfEquality) {
  EXPECT_THAT(Complete({"palpate", "solve", "--what", "="}), ElementsAre("material", "camera"));
  EXPECT_THAT(Complete({"palpate", "solve", "--what", "=", "ca"}), ElementsAre("camera"));
}

class ProcessCompletionTest : public BashTest {
 protected:
  static std::string Script() {
    Arguments arguments("palpate-x", "Do it");
    Options options;
    options.Declare(arguments);
    ::testing::internal::CaptureStdout();
    EXPECT_FALSE(arguments.Parse({"--completion", "bash"}));
    return ::testing::internal::GetCapturedStdout();
  }
  ProcessCompletionTest() : BashTest(Script()) {}
};

TEST_F(ProcessCompletionTest, CompletesAProgramWithoutVerbs) {
  EXPECT_THAT(Complete({"palpate-x", "b"}, "_palpate_x"), ElementsAre("beam"));
  EXPECT_THAT(Complete({"palpate-x", "beam", "--what", "m"}, "_palpate_x"),
              ElementsAre("material"));
  EXPECT_THAT(Complete({"palpate-x", "--comp"}, "_palpate_x"), ElementsAre("--completion"));
}

TEST(Completion, RefusesOtherShells) {
  EXPECT_THROW(RunVerbs("palpate", "Estimate", SolveAndInfo(), {"--completion", "fish"}),
               InputError);
  EXPECT_THROW(RunVerbs("palpate", "Estimate", SolveAndInfo(), {"--completion"}), InputError);
  Arguments process("palpate-x", "Do it");
  EXPECT_THROW(process.Parse({"--completion", "fish"}), InputError);
}

TEST(Completion, OffersNoWordThatTheScriptCouldNotHold) {
  const CommandText text{.name = "palpate-x",
                         .purpose = "Do it",
                         .arguments = {{.name = "ROBOT", .words = {"good", "it's", "$x", "a b"}}}};
  const std::string script = FormatBashCompletion(text, {});
  EXPECT_THAT(script, HasSubstr("words='good'"));
}

TEST(Help, SaysNeedRangeDefaultAndRepetition) {
  const std::string help = Output({"solve", "--help"});
  EXPECT_THAT(help, HasSubstr("Usage: palpate solve ROBOT --out FOLDER [OPTIONS]\n"));
  EXPECT_THAT(help, HasSubstr("  ROBOT                   Robot file\n"));
  EXPECT_THAT(help, HasSubstr("  --out FOLDER            Folder of the results [required]\n"));
  EXPECT_THAT(help, HasSubstr("What to estimate [default: material]\n"));
  EXPECT_THAT(help, HasSubstr("Use this recording [may be repeated]\n"));
  EXPECT_THAT(help, HasSubstr("Number of samples [from 10 to 2000; default: 120]\n"));
  EXPECT_THAT(help, HasSubstr("DDS domain; without it 0 [from 0 to 232]\n"));
  EXPECT_THAT(help, HasSubstr("Standard deviation, m [default: 0.002]\n"));
  EXPECT_THAT(help, Not(HasSubstr("--completion")));
}

TEST(Help, KeepsToEightyColumns) {
  std::string text = "word";
  for (int i = 0; i < 100; ++i) text += " word";
  const CommandText command{
      .name = "palpate-x",
      .purpose = text,
      .arguments = {
          {.name = "--long-option-name-that-needs-its-own-line", .value = "VALUE", .help = text}}};
  std::istringstream help(FormatHelp(command));
  std::vector<std::size_t> widths;
  for (std::string line; std::getline(help, line);) widths.push_back(line.size());
  EXPECT_THAT(widths, Each(::testing::Le(80u)));
  EXPECT_THAT(widths, SizeIs(::testing::Gt(10u)));
}

TEST(Version, EndsItsLine) {
  EXPECT_EQ(Output({"--version"}), std::string("palpate ") + Version() + "\n");
  EXPECT_EQ(Output({"solve", "--version"}), std::string("palpate solve ") + Version() + "\n");
}

TEST(ManualPage, NamesVerbsAndOptions) {
  EXPECT_THAT(Output({"--man"}), HasSubstr(".TP\n\\fBsolve\\fR\nSolve a model\n"));
  EXPECT_THAT(Output({"--man"}), HasSubstr("\\fBpalpate\\-info\\fR(1)"));
  const std::string page = Output({"solve", "--man"});
  EXPECT_THAT(page, HasSubstr(".TH \"PALPATE\\-SOLVE\" 1"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-\\-out\\fR \\fIFOLDER\\fR\nFolder of the results"));
}

TEST(ManualPage, PrintsTextAsItIs) {
  const CommandText text{.name = "palpate-x",
                         .purpose = "Do it",
                         .arguments = {{.name = "--set", .help = ".x\\y - 'z'"}}};
  EXPECT_THAT(FormatManualPage(text), HasSubstr("\n\\&.x\\ey \\- 'z'\n"));
}

TEST(ManualPage, HasNoWarningsOfGroff) {
  if (Shell("command -v groff").empty()) GTEST_SKIP() << "groff is not installed";
  for (const Words& words : {Words{"--man"}, Words{"solve", "--man"}, Words{"info", "--man"}}) {
    const auto file = std::filesystem::temp_directory_path() /
                      ("palpate_manual_test_" + std::to_string(::getpid()) + ".1");
    WriteFile(file, Output(words));
    EXPECT_EQ(Shell("groff -man -Tutf8 -ww -z " + file.string()), "") << words.front();
    std::filesystem::remove(file);
  }
}

}  // namespace
}  // namespace palpate::app
