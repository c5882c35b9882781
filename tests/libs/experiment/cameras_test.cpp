// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cameras.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

namespace fs = std::filesystem;
using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kLens =
    "depth: {width_px: 4, height_px: 3, fx_px: 3, fy_px: 3, cx_px: 1.5, cy_px: 1, unit_m: 0.001}\n";

/// Two recordings with a first camera; one of them with a second one.
class Cameras : public testing::Test {
 protected:
  Cameras() {
    Settings(
        "cameras:\n"
        "  - name: back\n"
        "    T_robot_camera: {translation_m: [0, 0, 0.4], rotation_xyzw: [1, 0, 0, 0]}\n"
        "    clock_offset_s: 0.25\n");
    for (const char* name : {"01_rest", "02_push"}) {
      folder_.Write(std::string("recordings/") + name + "/recording.yaml", "kind: rest\n");
      Image(std::string("recordings/") + name, {1'000'000'000, 1'033'000'000});
    }
    Image("recordings/02_push/cameras/back", {1'260'000'000});
  }

  void Settings(const std::string& text) { folder_.Write("experiment.yaml", text); }
  void Image(const std::string& in, const std::vector<std::int64_t>& t_ns) {
    folder_.Write(in + "/camera.yaml", kLens);
    fs::create_directories(folder_ / in / "depth");
    for (const std::int64_t t : t_ns) {
      rgbd::WriteDepthPng(folder_ / in / "depth" / (std::to_string(t) + ".png"),
                          rgbd::DepthImage(4, 3, 400));
    }
  }
  Experiment Read() const { return ReadExperiment(folder_.path(), app::LoadYaml); }
  std::string Refusal() const {
    try {
      Read();
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  TestFolder folder_;
};

TEST_F(Cameras, BesideTheFirstHaveFoldersOfTheirOwn) {
  const Experiment experiment = Read();
  EXPECT_THAT(FurtherCameras(experiment), ElementsAre("back"));
  EXPECT_EQ(experiment.recordings[0].cameras.size(), 0u);
  ASSERT_EQ(experiment.recordings[1].cameras.size(), 1u);
  EXPECT_EQ(experiment.recordings[1].cameras[0].depth_images.size(), 1u);
  EXPECT_EQ(experiment.recordings[1].depth_images.size(), 2u);
}

TEST_F(Cameras, AloneAreAnExperimentOfTheirOwnOnTheCommonClock) {
  const Experiment back = OfCamera(Read(), "back");
  EXPECT_EQ(back.T_robot_camera->translation().z(), 0.4);
  EXPECT_TRUE(back.recordings[0].depth_images.empty());
  ASSERT_EQ(back.recordings[1].depth_images.size(), 1u);
  EXPECT_EQ(back.recordings[1].depth_images[0].t_ns, 1'010'000'000);
  EXPECT_TRUE(back.recordings[1].camera_file.has_value());
  EXPECT_TRUE(std::holds_alternative<Eigen::Isometry3d>(RobotFromCamera(back, back.recordings[1])));
}

TEST_F(Cameras, OfARecordingWinOverThoseOfTheExperiment) {
  folder_.Write("recordings/02_push/recording.yaml",
                "kind: rest\ncameras:\n  - name: back\n    clock_offset_s: -0.5\n    "
                "T_robot_camera: {translation_m: [0, 0, 0.6], rotation_xyzw: [1, 0, 0, 0]}\n");
  const Experiment back = OfCamera(Read(), "back");
  EXPECT_EQ(back.recordings[1].depth_images[0].t_ns, 1'760'000'000);
  EXPECT_EQ(back.recordings[1].T_robot_camera->translation().z(), 0.6);
}

TEST_F(Cameras, AreWrittenAndReadBack) {
  const Experiment written = Read();
  WriteExperiment(written, folder_ / "copy");
  const Experiment read = ReadExperiment(folder_ / "copy", app::LoadYaml);
  ASSERT_EQ(read.cameras.size(), 1u);
  EXPECT_EQ(read.cameras[0].name, "back");
  EXPECT_EQ(read.cameras[0].clock_offset_s, 0.25);
  EXPECT_TRUE(read.cameras[0].T_robot_camera->isApprox(*written.cameras[0].T_robot_camera));
  EXPECT_EQ(read.recordings[1].cameras[0].depth_images[0].t_ns, 1'260'000'000);
}

TEST_F(Cameras, OfNoRecordingAreRefusedByName) {
  Settings("cameras:\n  - name: bakc\n");
  EXPECT_THAT(Refusal(), HasSubstr("no recording has a folder cameras/bakc"));
  EXPECT_THAT(Refusal(), HasSubstr("back"));
}

TEST_F(Cameras, OfNoNameOrOfOneTwiceAreRefused) {
  Settings("cameras:\n  - name: '2 b'\n");
  EXPECT_THAT(Refusal(), HasSubstr("letters, digits and '_'"));
  Settings("cameras:\n  - name: back\n  - name: back\n");
  EXPECT_THAT(Refusal(), HasSubstr("is there twice"));
  Settings("cameras:\n  - name: back\n");
  Image("recordings/01_rest/cameras/my-camera", {1});
  EXPECT_THAT(Refusal(), HasSubstr("is no name of a camera"));
}

}  // namespace
}  // namespace palpate::experiment
