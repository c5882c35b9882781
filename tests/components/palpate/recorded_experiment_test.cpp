// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "components/offline/messages/make_experiment.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "libs/app/child_process.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/rgbd/png.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
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

/// Images of two cameras, of which the second is 12 ms late.
class RecordedCameras : public testing::Test {
 protected:
  static constexpr std::int64_t kLate_ns = 12'000'000;

  RecordedCameras() {
    folder_.Write("played/experiment.yaml",
                  "robot: none.yaml\nframe: camera\n"
                  "T_robot_camera: {translation_m: [0, 0, 1], rotation_xyzw: [1, 0, 0, 0]}\n"
                  "cameras:\n  - name: back\n"
                  "    T_robot_camera: {translation_m: [0, 1, 0], rotation_xyzw: [0, 1, 0, 0]}\n");
    const std::filesystem::path recording = "played/recordings/a";
    folder_.Write(recording / "recording.yaml", "kind: free\n");
    WriteImages(recording, 0, 100);
    WriteImages(recording / "cameras/back", kLate_ns, 200);
  }

  /// Three images, of which the first pixel says which one it is.
  void WriteImages(const std::filesystem::path& path, std::int64_t late_ns, std::uint16_t first) {
    rgbd::RgbdCamera camera;
    camera.depth = camera.color = {4, 3, 5.0, 5.0, 1.5, 1.0, {}};
    camera.color_registered = true;
    folder_.Write(path / "camera.yaml", rgbd::FormatCameraFile(camera));
    for (std::uint16_t i = 0; i < 3; ++i) {
      const std::string file = std::to_string(100'000'000 * i + late_ns) + ".png";
      const auto whole = folder_.path() / path;
      std::filesystem::create_directories(whole / "depth");
      std::filesystem::create_directories(whole / "color");
      rgbd::WriteDepthPng(whole / "depth" / file,
                          rgbd::DepthImage(4, 3, static_cast<std::uint16_t>(first + i)));
      rgbd::WriteColorPng(whole / "color" / file, rgbd::ColorImage(4, 3, 9));
    }
  }

  const TestFolder folder_;
};

TEST_F(RecordedCameras, AreThoseOfTheFolderWithTheirTimesAndPoses) {
  const auto file = folder_ / "run.mcap";
  app::ChildProcess recorder(kProgramFolder / "palpate-recorder", {"--out", file.string()}, {},
                             folder_ / "recorder");
  app::ChildProcess player(kProgramFolder / "palpate-player",
                           {"--data", (folder_ / "played").string(), "--images"}, {},
                           folder_ / "player");
  ASSERT_EQ(player.Wait(), 0) << ReadFile(folder_ / "player");
  ASSERT_EQ(recorder.Stop(), 0) << ReadFile(folder_ / "recorder");
  offline::MakeExperiment(file, {}, {}, folder_ / "made", app::LoadYaml);
  const auto made = experiment::ReadExperiment(folder_ / "made", app::LoadYaml);
  const auto played = experiment::ReadExperiment(folder_ / "played", app::LoadYaml);
  EXPECT_EQ(experiment::FurtherCameras(made), std::vector<std::string>{"back"});
  ASSERT_EQ(made.recordings.size(), 1u);
  for (const std::string& name : {std::string(), std::string("back")}) {
    const auto of = [&](const experiment::Experiment& all) {
      return name.empty() ? all : experiment::OfCamera(all, name);
    };
    const experiment::Recording a = of(made).recordings[0];
    const experiment::Recording b = of(played).recordings[0];
    ASSERT_EQ(a.depth_images.size(), 3u) << name;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(a.depth_images[i].t_ns, b.depth_images[i].t_ns) << name;
      EXPECT_EQ(ReadFile(a.depth_images[i].file), ReadFile(b.depth_images[i].file)) << name;
    }
    EXPECT_EQ(a.color_images.size(), 3u) << name;
    ASSERT_TRUE(of(made).T_robot_camera) << name;
    EXPECT_TRUE(of(made).T_robot_camera->isApprox(*of(played).T_robot_camera, 1e-12)) << name;
  }
}

}  // namespace
}  // namespace palpate::command
