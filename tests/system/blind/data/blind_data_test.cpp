// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_body.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/blind/corruption.hpp"
#include "tests/system/blind/generator.hpp"
#include "tests/system/blind/open_answer.hpp"
#include "tests/system/sample_data.hpp"

/// What `palpate simulate` makes for the blind tests: one experiment each of a misplaced marker and
/// of a lag, with the same seed, in a few seconds.
namespace palpate::blind {
namespace {

namespace fs = std::filesystem;
using scenario::ActiveEffect;
using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

constexpr std::uint64_t kSeed = 77;
constexpr double kMisplaced_m = 0.006;
const ActiveEffect kMisplaced{
    .id = "marker_misplacement", .where = {"marker:tip"}, .parameters = {{"d_m", kMisplaced_m}}};
const ActiveEffect kLate{.id = "lag", .where = {"body"}, .parameters = {{"delay_s", 0.2}}};

class BlindData : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TestFolder;
    generator_ = new Generator(test_support::RobotFile("four_leg"), *folder_ / "");
    generator_->Keep({"R0_rest", "RA_north", "RB_repeat", "RZ_rest"});
    generator_->Make({kMisplaced}, kSeed, Experiment(), Answer());
    generator_->Make({kLate}, kSeed, Late(), *folder_ / "late.answer.json");
  }
  static void TearDownTestSuite() {
    delete generator_;
    delete folder_;
  }
  static fs::path Experiment() { return *folder_ / "one"; }
  static fs::path Answer() { return *folder_ / "one.answer.json"; }
  static fs::path Late() { return *folder_ / "late"; }

  /// Of the first experiment, in a folder of this test.
  fs::path Copy() {
    fs::copy(Experiment(), copies_.path() / "copy", fs::copy_options::recursive);
    return copies_.path() / "copy";
  }
  /// Files whose bytes are not those of the first experiment, or that are gone.
  static std::vector<std::string> Changed(const fs::path& copy) {
    std::vector<std::string> changed;
    for (const std::string& file : Files(Experiment())) {
      if (!fs::exists(copy / file) || ReadFile(copy / file) != ReadFile(Experiment() / file)) {
        changed.push_back(file);
      }
    }
    return changed;
  }
  static std::vector<std::string> Files(const fs::path& experiment) {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(experiment)) {
      if (!entry.is_regular_file()) continue;
      files.push_back(entry.path().lexically_relative(experiment).generic_string());
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  static experiment::Experiment Read(const fs::path& folder) {
    return experiment::ReadExperiment(folder, app::LoadYaml);
  }

  static TestFolder* folder_;
  static Generator* generator_;
  TestFolder copies_;
};

TestFolder* BlindData::folder_ = nullptr;
Generator* BlindData::generator_ = nullptr;

TEST_F(BlindData, TheAnswerIsWhatWasHiddenWithoutClutter) {
  const std::vector<ActiveEffect> truth = OpenAnswer(Experiment(), Answer());
  ASSERT_EQ(truth.size(), 1u);
  EXPECT_EQ(truth[0].id, kMisplaced.id);
  EXPECT_EQ(truth[0].where, kMisplaced.where);
  EXPECT_EQ(truth[0].parameters, kMisplaced.parameters);
  EXPECT_THAT(ReadFile(Answer()), HasSubstr("\"clutter\""));
}

TEST_F(BlindData, ABrokenSealIsRefused) {
  const auto open = [](const fs::path& data, const fs::path& answer) {
    return MessageOf<RunError>([&] { OpenAnswer(data, answer); });
  };
  const fs::path forged = copies_.path() / "forged.json";
  std::string text = ReadFile(Answer());
  text.replace(text.find("marker:tip"), 10, "marker:top");
  WriteFile(forged, text);
  EXPECT_THAT(open(Experiment(), forged), HasSubstr("the seal is broken"));
  EXPECT_THAT(open(Late(), Answer()), HasSubstr("the seal is broken"));
  EXPECT_THAT(open(Experiment(), copies_.path() / "none.json"), HasSubstr("the seal is broken"));
  const fs::path copy = Copy();
  Corrupt(Corruption::kFrozenMarkers, kSeed, copy);
  EXPECT_THAT(open(copy, Answer()), HasSubstr("the seal is broken"));
}

TEST_F(BlindData, NamesCountsAndTimesDoNotDependOnTheCause) {
  EXPECT_EQ(Files(Experiment()), Files(Late()));
  const auto one = Read(Experiment());
  const auto late = Read(Late());
  EXPECT_EQ(one.notes, late.notes);
  for (std::size_t r = 0; r < one.recordings.size(); ++r) {
    const auto& a = one.recordings[r];
    const auto& b = late.recordings[r];
    EXPECT_EQ(a.notes, b.notes);
    EXPECT_EQ(a.actuation->t_s, b.actuation->t_s);
    EXPECT_EQ(a.markers->names, b.markers->names);
    ASSERT_EQ(a.markers->frames.size(), b.markers->frames.size());
    for (std::size_t i = 0; i < a.markers->frames.size(); ++i) {
      EXPECT_EQ(a.markers->frames[i].t_s, b.markers->frames[i].t_s);
    }
    // As many digits, but for zeros in their ends.
    const fs::path file = fs::path("recordings") / a.name / "markers.csv";
    const double size = static_cast<double>(fs::file_size(Experiment() / file));
    EXPECT_NEAR(static_cast<double>(fs::file_size(Late() / file)) / size, 1.0, 0.02);
  }
  for (const char* word : {"misplace", "lag", "effect", "seed"}) {
    for (const std::string& file : Files(Experiment())) {
      EXPECT_EQ(ReadFile(Experiment() / file).find(word), std::string::npos) << file;
    }
  }
}

/// The lag does nothing while the robot rests, and a misplaced marker leaves the others alone; in
/// the end the creep that every robot has still remembers that it came there later.
TEST_F(BlindData, NoiseAndClutterAreTheSeeds) {
  const auto one = Read(Experiment());
  const auto late = Read(Late());
  const double sigma_m = one.markers_sigma_m->x();
  for (const bool at_end : {false, true}) {
    const auto& a = *(at_end ? one.recordings.back() : one.recordings.front()).markers;
    const auto& b = *(at_end ? late.recordings.back() : late.recordings.front()).markers;
    for (std::size_t m = 0; m < a.names.size(); ++m) {
      for (std::size_t i = 0; i < a.frames.size(); ++i) {
        const double apart_m = (*a.frames[i].positions_m[m] - *b.frames[i].positions_m[m]).norm();
        if (a.names[m] == "tip") {
          EXPECT_GT(apart_m, 0.5 * kMisplaced_m);
        } else {
          EXPECT_LT(apart_m, at_end ? 0.01 * sigma_m : 1e-12);
        }
      }
    }
  }
}

/// One of nine markers is off by d, in some direction: d / sqrt(27) over all coordinates.
TEST_F(BlindData, TheSizeOfAnEffectIsHowFarItMovesTheMarkers) {
  const std::vector<double> sizes_m = generator_->EffectSizes_m({kMisplaced}, kSeed, Experiment());
  ASSERT_EQ(sizes_m.size(), 1u);
  EXPECT_NEAR(sizes_m[0], kMisplaced_m / std::sqrt(27.0), 5e-5);
  EXPECT_FALSE(fs::exists(*folder_ / "one_without_0"));
}

TEST_F(BlindData, CorruptionsHitOneRecordingAndWhatTheySay) {
  for (const Corruption corruption : {Corruption::kShuffledStamps, Corruption::kFrozenMarkers,
                                      Corruption::kNotANumber, Corruption::kMissingActuation}) {
    SCOPED_TRACE(ToString(corruption));
    const fs::path copy = Copy();
    Corrupt(corruption, kSeed, copy);
    const auto changed = Changed(copy);
    ASSERT_EQ(changed.size(), 1u);
    const bool is_actuation = corruption == Corruption::kMissingActuation;
    EXPECT_THAT(changed[0], HasSubstr(is_actuation ? "actuation.csv" : "markers.csv"));
    EXPECT_EQ(changed[0].find("rest"), std::string::npos);
    if (corruption == Corruption::kFrozenMarkers) {
      const auto frames = experiment::ReadMarkers(copy / changed[0]).frames;
      EXPECT_EQ(*frames[frames.size() / 5 + 1].positions_m[3], *frames.back().positions_m[3]);
      EXPECT_NE(*frames.front().positions_m[3], *frames.back().positions_m[3]);
    } else if (!is_actuation) {
      EXPECT_THROW(experiment::ReadMarkers(copy / changed[0]), InputError);
    }
    fs::remove_all(copy);
  }
  const fs::path copy = Copy();
  Corrupt(Corruption::kOtherRobot, kSeed, copy);
  EXPECT_THAT(Changed(copy), testing::IsEmpty());
}

TEST_F(BlindData, TheOtherRobotIsOneThatCanBeBuilt) {
  const robot::RobotDescription robot = test_support::FourLegRobot();
  std::set<std::string> names;
  for (std::uint64_t seed = kSeed; seed < kSeed + 8; ++seed) {
    const fs::path file = OtherRobotFile(seed, robot, copies_.path());
    const auto other = robot::ReadRobotFile(file, app::LoadYaml);
    names.insert(other.name);
    const auto body = robot::BuildRobotBody(other);
    if (other.name != robot.name) continue;
    EXPECT_NEAR(body.markers[0].point.rest_m.z() / robot.markers[0].position_m.z(), 1.4, 0.01);
  }
  EXPECT_EQ(names.size(), 2u);
}

}  // namespace
}  // namespace palpate::blind
