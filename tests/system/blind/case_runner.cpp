// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/case_runner.hpp"

#include <chrono>
#include <utility>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/system/blind/corruption.hpp"
#include "tests/system/blind/kept_record.hpp"
#include "tests/system/blind/open_answer.hpp"
#include "tests/system/blind/rod_meshes.hpp"
#include "tests/system/process.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

// In the folders of a case.
constexpr char kExperiment[] = "experiment";
constexpr char kDiagnosis[] = "diagnosis";
constexpr char kAnswer[] = "answer.json";
constexpr char kRecord[] = "record.json";

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
  if (settings_.keep && TakeKept(drawn, &record)) return record;
  const WorkFolder sealed(Sealed(seed), settings_.keep);
  const WorkFolder open(Open(seed), settings_.keep);
  RunAnew(drawn, &record);
  if (settings_.keep) KeepRecord(record, HowAsked(), sealed.path() / kRecord);
  return record;
}

std::string CaseRunner::HowAsked() const {
  return "--samples " + std::to_string(settings_.samples) + " --minutes " +
         std::to_string(settings_.minutes) +
         (settings_.measured == Measured::kPictures ? " of pictures" : "");
}

/// Of a case that was run to its end before.
bool CaseRunner::TakeKept(const BlindCase& drawn, CaseRecord* record) const {
  const fs::path sealed = Sealed(drawn.seed);
  if (!ReadKeptRecord(sealed / kRecord, HowAsked(), record)) return false;
  if (!record->not_made.empty()) {
    record->truth = drawn.effects;
    return true;
  }
  record->truth = OpenAnswer(sealed / kExperiment, sealed / kAnswer);
  if (record->no_verdict.empty()) {
    record->verdict = ReadVerdict(Open(drawn.seed) / kDiagnosis / "verdict.json");
  }
  return true;
}

void CaseRunner::RunAnew(const BlindCase& drawn, CaseRecord* record) const {
  const fs::path sealed = Sealed(drawn.seed);
  const fs::path open = Open(drawn.seed);
  const fs::path made = sealed / kExperiment;
  const Generator generator(settings_.robot_file, sealed, settings_.measured);
  try {
    generator.Make(drawn.effects, drawn.seed, made, sealed / kAnswer);
    if (drawn.kind != CaseKind::kCorrupted) {  // of which no cause is asked
      record->sizes_m = generator.EffectSizes_m(drawn.effects, drawn.seed, made);
    }
  } catch (const RunError& error) {
    record->truth = drawn.effects;
    record->not_made = LastLine(error.what());
    return;
  }
  fs::copy(made, open / kExperiment, fs::copy_options::recursive);
  Corrupt(drawn.corruption, drawn.seed, open / kExperiment);
  Diagnose(drawn, open / kExperiment, open / kDiagnosis, record);
  record->truth = OpenAnswer(made, sealed / kAnswer);
}

fs::path CaseRunner::DiagnosedRobotFile(const BlindCase& drawn, const fs::path& folder) const {
  if (drawn.corruption == Corruption::kOtherRobot)
    return OtherRobotFile(drawn.seed, robot_, folder);
  if (settings_.robot_file.stem() == "rod") return WriteDiagnosedRod(drawn.seed, robot_, folder);
  return settings_.robot_file;
}

void CaseRunner::Diagnose(const BlindCase& drawn, const fs::path& data, const fs::path& out,
                          CaseRecord* record) const {
  const fs::path robot = DiagnosedRobotFile(drawn, data.parent_path());
  std::vector<std::string> arguments = {"diagnose",  robot.string(),
                                        "--data",    data.string(),
                                        "--out",     out.string(),
                                        "--samples", std::to_string(settings_.samples),
                                        "--minutes", std::to_string(settings_.minutes)};
  if (!drawn.without.empty())
    arguments.insert(arguments.end(), {"--exclude", Joined(drawn.without)});
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
