// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libs/core/file.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/blind/palpate_command.hpp"
#include "tests/system/blind/picture_camera.hpp"

/// `palpate diagnose` on depth images alone: a robot of few cells before a small camera with noise
/// and smooth errors of its own.
namespace palpate::blind {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::HasSubstr;

const fs::path kRepository = PALPATE_SOURCE_DIR;

/// Each cable, two against each other, a known weight, the base tilted; then the camera elsewhere.
const std::string kScenario = R"(name: pictures
body: {refine: 0, element: tet10}
motion: {mode: quasi_static, time_step_s: 0.1}
effects: []
clutter: 1
)" + kPictureCamera + R"(  rate_hz: 2
rest_between_s: 2
recordings:
  - name: R0_rest
    kind: rest
    duration_s: 2
    commands:
      - {t_s: 0, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
  - name: RA_cables
    kind: ramp
    duration_s: 10
    commands:
      - {t_s: 0, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 2, north.displacement_m: 0.016, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 4, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0.016}
      - {t_s: 6, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0.016, east.displacement_m: 0}
      - {t_s: 8, north.displacement_m: 0, west.displacement_m: 0.016, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 10, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
  - name: RB_again
    kind: repeat
    duration_s: 8
    commands:
      - {t_s: 0, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 2, north.displacement_m: 0.016, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 4, north.displacement_m: 0.008, west.displacement_m: 0.014, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 6, north.displacement_m: 0.012, west.displacement_m: 0.012, south.displacement_m: 0.012, east.displacement_m: 0.012}
      - {t_s: 8, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
  - name: RM_moved
    kind: camera_moved
    duration_s: 3
    eye_m: [-0.10, 0.10, 0.62]
    target_m: [0.03, 0.02, 0.09]
    commands:
      - {t_s: 0, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 3, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0.012}
  - name: RS_weight
    kind: known_load
    duration_s: 6
    commands:
      - {t_s: 0, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
    weights:
      - {t_s: 0, position_m: [0, 0, 0.125], mass_kg: 0.05, patch_radius_m: 0.008}
      - {t_s: 3, position_m: [0.0598, 0, 0.0858], mass_kg: 0.05, patch_radius_m: 0.008}
  - name: RT_tilt
    kind: base_tilted
    duration_s: 4
    commands:
      - {t_s: 0, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 2, north.displacement_m: 0, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
      - {t_s: 4, north.displacement_m: 0.012, west.displacement_m: 0, south.displacement_m: 0, east.displacement_m: 0}
    base_tilt_deg: [15, 0]
)";

class DiagnosePictures : public testing::Test {
 protected:
  /// The robot file's robot of fewer cells, and an experiment with this hidden in it.
  void Make(const std::string& effect, int seed) {
    std::string robot = ReadFile(kRepository / "config/robots/four_leg.yaml");
    const fs::path mesh = kRepository / "config/scenarios/four_leg_coarse.msh";
    Replace("file: four_leg.msh", "file: " + mesh.string(), &robot);
    WriteFile(Robot(), robot);
    std::string scenario = kScenario;
    Replace("effects: []", "effects: [" + effect + "]", &scenario);
    WriteFile(folder_.path() / "scenario.yaml", scenario);
    const auto made =
        Palpate({"simulate", Robot(), "--scenario", folder_.path() / "scenario.yaml", "--seed",
                 std::to_string(seed), "--tell-camera-pose", "--out", Experiment().string()},
                folder_.path() / "simulate.log");
    ASSERT_EQ(made, 0) << ReadFile(folder_.path() / "simulate.log");
    RecordProperty("seed", seed);
  }

  Json Diagnose(int expected_exit = 0, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"diagnose",   Robot(), "--data",
                                          Experiment(), "--out", (folder_.path() / "out").string(),
                                          "--samples",  "30"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(Palpate(arguments, folder_.path() / "diagnose.log"), expected_exit)
        << ReadFile(folder_.path() / "diagnose.log");
    return Json::parse(ReadFile(folder_.path() / "out" / "verdict.json"));
  }

  /// Named first, its first parameter is near, and it tells much of what tolerances do not.
  static void ExpectFirst(const Json& verdict, const std::string& id, const std::string& parameter,
                          double value, double tolerance) {
    ASSERT_FALSE(verdict["causes"].empty()) << verdict.dump(1);
    const Json& cause = verdict["causes"][0];
    EXPECT_EQ(cause["id"], id) << verdict.dump(1);
    ASSERT_TRUE(cause["parameters"].contains(parameter)) << cause.dump(1);
    EXPECT_NEAR(cause["parameters"][parameter]["value"].get<double>(), value, tolerance);
    EXPECT_GT(cause["explained_share"].get<double>(), 0.3) << cause.dump(1);
  }

  /// Depth images of a recording, by time.
  std::vector<fs::path> Images(const std::string& recording) const {
    std::vector<fs::path> images;
    for (const auto& entry :
         fs::directory_iterator(Experiment() / "recordings" / recording / "depth")) {
      images.push_back(entry.path());
    }
    const auto stamp = [](const fs::path& image) { return std::stoll(image.stem().string()); };
    std::sort(images.begin(), images.end(),
              [&](const fs::path& a, const fs::path& b) { return stamp(a) < stamp(b); });
    return images;
  }

  fs::path Experiment() const { return folder_.path() / "exp"; }
  std::string Robot() const { return (folder_.path() / "robot.yaml").string(); }

  test_support::TestFolder folder_;
};

TEST_F(DiagnosePictures, AcquitsAHealthyRobotBeforeACameraThatErrs) {
  Make("", 21);
  const Json verdict = Diagnose();
  EXPECT_TRUE(verdict["causes"].empty()) << verdict.dump(1);
  EXPECT_EQ(verdict["verdict"], "no_fault") << verdict["reason"];
}

TEST_F(DiagnosePictures, NameASofterBody) {
  Make("{id: youngs_modulus, where: body, factor: 0.7}", 22);
  const Json verdict = Diagnose();
  ExpectFirst(verdict, "youngs_modulus", "factor", 0.7, 0.04);
  const Json& error_N = verdict["force_error_N_rms"];
  EXPECT_LT(error_N["after"].get<double>(), 0.7 * error_N["before"].get<double>());
}

TEST_F(DiagnosePictures, NameADepthScale) {
  Make("{id: depth_scale, where: camera, s: 0.02}", 23);
  ExpectFirst(Diagnose(), "depth_scale", "s", 0.02, 0.006);
}

/// The robot bends to a side that was not commanded: little of its surface is where it is expected.
TEST_F(DiagnosePictures, NameExchangedCables) {
  Make("{id: swapped_cables, where: [cable:north, cable:west]}", 25);
  const Json verdict = Diagnose();
  ASSERT_EQ(verdict["causes"].size(), 1u) << verdict.dump(1);
  EXPECT_EQ(verdict["causes"][0]["id"], "swapped_cables") << verdict.dump(1);
  EXPECT_EQ(verdict["causes"][0]["where"], Json({"cable:north", "cable:west"}));
  EXPECT_EQ(verdict["verdict"], "cause") << verdict["reason"];
}

TEST_F(DiagnosePictures, OfNoUseAreRefusedWithTheReason) {
  Make("", 24);
  const auto reason = [&] {
    const Json verdict = Diagnose(1);
    EXPECT_EQ(verdict["verdict"], "data_unfit");
    EXPECT_TRUE(verdict["causes"].empty());
    return verdict["reason"].get<std::string>();
  };
  const std::vector<fs::path> images = Images("RA_cables");
  std::vector<std::string> right;
  for (const fs::path& image : images) right.push_back(ReadFile(image));

  for (std::size_t k = 4; k < images.size(); ++k) WriteFile(images[k], right[3]);
  EXPECT_THAT(reason(), HasSubstr("RA_cables: depth frames are identical to the last digit"));

  for (std::size_t k = 0; k < images.size(); ++k) {
    WriteFile(images[k], right[7 * k % images.size()]);
  }
  EXPECT_THAT(reason(), HasSubstr("RA_cables: the clouds jump while the cables move steadily"));

  for (std::size_t k = 0; k < images.size(); ++k) WriteFile(images[k], right[k].substr(0, 100));
  EXPECT_THAT(reason(), HasSubstr(".png"));

  for (std::size_t k = 0; k < images.size(); ++k) WriteFile(images[k], right[k]);
  const fs::path camera = Experiment() / "recordings/RB_again/camera.yaml";
  const std::string data_sheet = ReadFile(camera);
  fs::remove(camera);
  EXPECT_THAT(reason(), HasSubstr("camera.yaml"));
  WriteFile(camera, data_sheet);

  const rgbd::DepthImage nothing(424, 240);
  for (const std::string name : {"R0_rest", "RA_cables", "RB_again", "RM_moved"}) {
    for (const fs::path& image : Images(name)) rgbd::WriteDepthPng(image, nothing);
  }
  EXPECT_THAT(reason(), HasSubstr("the robot is seen in"));
}

}  // namespace
}  // namespace palpate::blind
