// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <memory>

#include "components/offline/messages/make_experiment.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "libs/app/child_process.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/experiment.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::TestFolder;

const std::filesystem::path kPlayedBeam = PALPATE_SOURCE_DIR "/tests/data/beam_calculix";
const std::filesystem::path kProgramFolder = PALPATE_BINARY_DIR "/bin";

/// An experiment that was played, recorded, and read again.
class RecordedExperiment : public testing::Test {
 protected:
  /// Both recordings of the beam begin at 0.
  void PlayAndRecord() {
    app::ChildProcess recorder(kProgramFolder / "palpate-recorder",
                               {"--out", file_.string(), "--robot", "beam"}, {},
                               folder_ / "recorder");
    app::ChildProcess player(kProgramFolder / "palpate-player",
                             {"--data", kPlayedBeam.string(), "--rate", "8"}, {},
                             folder_ / "player");
    ASSERT_EQ(player.Wait(), 0) << ReadFile(folder_ / "player");
    ASSERT_EQ(recorder.Stop(), 0) << ReadFile(folder_ / "recorder");
    // What no topic says.
    folder_.Write("run.phases.yaml",
                  "phases:\n"
                  "  - {name: hung_weight, kind: free, steady_window_s: [1.55, 2.95],\n"
                  "     reference: {window_s: [0, 1], shape: undeformed}}\n"
                  "  - {name: self_weight, kind: rest, steady_window_s: [1.55, 2.95],\n"
                  "     reference: {window_s: [0, 1], shape: undeformed}}\n");
  }

  /// forces.csv of two frames a second.
  std::string ForcesOf(const std::filesystem::path& data, const std::string& name) {
    EstimateOptions options;
    options.robot = "beam";
    options.data = data;
    options.rate_Hz = 2.0;
    options.out = folder_ / name;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Estimate(options);
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    return ReadFile(options.out);
  }

  const TestFolder folder_;
  const std::filesystem::path file_ = folder_ / "run.mcap";
};

TEST_F(RecordedExperiment, HasTheMarkersAndForcesOfTheFolderBitForBit) {
  PlayAndRecord();
  offline::MakeExperiment(file_, {}, {}, folder_ / "made", app::LoadYaml);
  const auto made = experiment::ReadExperiment(folder_ / "made", app::LoadYaml);
  const auto played = experiment::ReadExperiment(kPlayedBeam, app::LoadYaml);
  ASSERT_EQ(made.recordings.size(), 2u);
  EXPECT_EQ(made.markers_sigma_m, played.markers_sigma_m);
  for (const std::size_t r : {0u, 1u}) {
    ASSERT_EQ(made.recordings[r].name, played.recordings[r].name);
    const auto& a = *made.recordings[r].markers;
    const auto& b = *played.recordings[r].markers;
    ASSERT_EQ(a.names, b.names);
    ASSERT_EQ(a.frames.size(), b.frames.size());
    for (std::size_t i = 0; i < a.frames.size(); ++i) {
      EXPECT_EQ(a.frames[i].t_s, b.frames[i].t_s);
      EXPECT_EQ(a.frames[i].positions_m, b.frames[i].positions_m);
    }
  }
  EXPECT_EQ(ForcesOf(file_, "of_file.csv"), ForcesOf(kPlayedBeam, "of_folder.csv"));
}

}  // namespace
}  // namespace palpate::command
