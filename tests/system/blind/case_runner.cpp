// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/case_runner.hpp"

#include <chrono>
#include <utility>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/system/blind/corruption.hpp"
#include "tests/system/blind/open_answer.hpp"
#include "tests/system/process.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

/// A new folder, which goes with what is in it unless it is to be kept.
class WorkFolder {
 public:
  WorkFolder(fs::path path, bool keep) : path_(std::move(path)), keep_(keep) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~WorkFolder() {
    std::error_code ignored;
    if (!keep_) fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool keep_;
};

std::string LastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

}  // namespace

CaseRunner::CaseRunner(Settings settings)
    : settings_(std::move(settings)),
      robot_(robot::ReadRobotFile(settings_.robot_file, app::LoadYaml)) {}

CaseRecord CaseRunner::Run(std::uint64_t seed) const {
  const BlindCase drawn = DrawCase(seed, robot_, settings_.measured);
  CaseRecord record{.seed = seed, .kind = drawn.kind, .corruption = drawn.corruption};
  const std::string number = std::to_string(cases_++);
  const WorkFolder sealed(settings_.folder / ("sealed" + number), settings_.keep);
  const WorkFolder open(settings_.folder / ("open" + number), settings_.keep);
  const fs::path made = sealed.path() / "experiment";
  const fs::path answer = sealed.path() / "answer.json";
  const Generator generator(settings_.robot_file, sealed.path(), settings_.measured);
  try {
    generator.Make(drawn.effects, seed, made, answer);
    if (drawn.kind != CaseKind::kCorrupted) {  // of which no cause is asked
      record.sizes_m = generator.EffectSizes_m(drawn.effects, seed, made);
    }
  } catch (const RunError& error) {
    record.truth = drawn.effects;
    record.not_made = LastLine(error.what());
    return record;
  }
  const fs::path data = open.path() / "experiment";
  fs::copy(made, data, fs::copy_options::recursive);
  Corrupt(drawn.corruption, seed, data);
  Diagnose(drawn, data, open.path() / "diagnosis", &record);
  record.truth = OpenAnswer(made, answer);
  return record;
}

void CaseRunner::Diagnose(const BlindCase& drawn, const fs::path& data, const fs::path& out,
                          CaseRecord* record) const {
  const fs::path robot = drawn.corruption == Corruption::kOtherRobot
                             ? OtherRobotFile(drawn.seed, robot_, data.parent_path())
                             : settings_.robot_file;
  std::vector<std::string> arguments = {"diagnose",  robot.string(),
                                        "--data",    data.string(),
                                        "--out",     out.string(),
                                        "--samples", std::to_string(settings_.samples),
                                        "--minutes", std::to_string(settings_.minutes)};
  if (!drawn.without.empty())
    arguments.insert(arguments.end(), {"--without", Joined(drawn.without)});
  const auto begin = steady_clock::now();
  system_test::Process program("palpate", arguments, data.parent_path() / "diagnose.log");
  const auto done = program.Wait(std::chrono::seconds(settings_.longest_diagnosis_s));
  record->diagnosis_s = std::chrono::duration<double>(steady_clock::now() - begin).count();
  const std::string exit = done ? "exit code " + std::to_string(*done) : "took too long";
  if (!fs::exists(out / "verdict.json")) {
    record->no_verdict = exit + ": " + LastLine(program.Output());
    return;
  }
  try {
    record->verdict = ReadVerdict(out / "verdict.json");
  } catch (const RunError& error) {
    record->no_verdict = LastLine(error.what());
  }
}

}  // namespace palpate::blind
