// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

using testing::HasSubstr;

/// A bar with one cable and seven markers, seen by a camera, whose drive counts from 0.7 mm in.
class CalibrateCamera : public testing::Test {
 protected:
  CalibrateCamera() {
    std::filesystem::create_directories(folder_ / "data/recordings");
    folder_.Write("data/experiment.yaml", "frame: camera\nmarkers_sigma_m: 1.0e-4\n");
    for (const double commanded_m : {0.002, 0.005, 0.008}) Record(commanded_m);
  }

  static std::filesystem::path WriteRobot(const TestFolder& folder) {
    const std::filesystem::path file = WriteBarRobot(folder);
    std::string text = ReadFile(file);
    const std::string old = "markers: [{name: tip, position_m: [0.08, 0.01, 0.02]}]";
    const std::string markers =
        "markers: [{name: tip, position_m: [0.08, 0.01, 0.02]}, "
        "{name: a, position_m: [0.08, 0.0, 0.0]}, {name: b, position_m: [0.08, 0.02, 0.0]}, "
        "{name: c, position_m: [0.04, 0.0, 0.02]}, {name: d, position_m: [0.04, 0.02, 0.02]}, "
        "{name: e, position_m: [0.02, 0.01, 0.0]}, {name: f, position_m: [0.06, 0.02, 0.01]}]";
    text.replace(text.find(old), old.size(), markers);
    text.replace(text.find("max_tension_N: 1"), 16, "max_tension_N: 9");
    return folder.Write("bar.yaml", text);
  }

  void Record(double commanded_m) const {
    const auto model = LoadRobot(robot_, {});
    fem::StaticState state = model->RestState();
    using Kind = robot::ActuatorCommand::Kind;
    const auto result = model->Solve({{Kind::kDisplacement, commanded_m + kOffset_m}}, {}, &state);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
    const std::string name =
        "data/recordings/hold_" + std::to_string(static_cast<int>(1e3 * commanded_m));
    std::filesystem::create_directories(folder_ / name);
    folder_.Write(name + "/recording.yaml", "kind: hold\n");
    const std::string value = FormatNumber(commanded_m);
    folder_.Write(name + "/actuation.csv",
                  "t_s,top.displacement_m\n0," + value + "\n1," + value + "\n");
    std::string markers = "t_s,marker,x_m,y_m,z_m\n";
    for (const robot::BodyMarker& marker : model->body().markers) {
      const Eigen::Vector3d seen_m =
          T_robot_camera_.inverse() * marker.point.weights.Position(state.x_m);
      markers += "0.5," + marker.name;
      for (int i = 0; i < 3; ++i) markers += "," + FormatNumber(seen_m[i]);
      markers += "\n";
    }
    folder_.Write(name + "/markers.csv", markers);
  }

  CalibrateOptions Options() const {
    CalibrateOptions options;
    options.robot = robot_;
    options.data = folder_ / "data";
    options.out = folder_ / "calibration.yaml";
    return options;
  }

  robot::CalibrationFile Run(const CalibrateOptions& options) const {
    EXPECT_EQ(Calibrate(options), 0);
    return robot::ReadCalibrationFile(options.out, app::LoadYaml);
  }

  static constexpr double kOffset_m = 7e-4;
  TestFolder folder_;
  std::filesystem::path robot_ = WriteRobot(folder_);
  Eigen::Isometry3d T_robot_camera_ =
      Eigen::Translation3d(0.3, -0.2, 0.4) *
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.8, 0.5).normalized());
};

TEST_F(CalibrateCamera, FindsPoseZeroOfTheDriveAndModulusWithoutBeingTold) {
  const robot::CalibrationFile file = Run(Options());
  ASSERT_TRUE(file.pose);
  EXPECT_TRUE(file.pose->T_robot_camera.isApprox(T_robot_camera_, 1e-4));
  EXPECT_GT(file.pose->translation_error_m.minCoeff(), 0.0);
  ASSERT_EQ(file.drives.size(), 1U);
  EXPECT_EQ(file.drives[0].cable, "top");
  EXPECT_NEAR(file.drives[0].drive.offset_m, kOffset_m, 2e-6);
  EXPECT_GT(file.drives[0].standard_error.offset_m, 0.0);
  ASSERT_EQ(file.moduli.size(), 1U);  // told by the bar's own weight
  EXPECT_NEAR(file.moduli[0].youngs_modulus_Pa, 100e3,
              3.0 * file.moduli[0].standard_error_Pa + 100.0);
  EXPECT_LE(file.residual_rms_m, 2e-6);
}

TEST_F(CalibrateCamera, FindsTheModulusWithThem) {
  std::string text = ReadFile(robot_);
  text.replace(text.find("100.0e3"), 7, "130.0e3");
  folder_.Write("bar.yaml", text);
  CalibrateOptions options = Options();
  options.what = "joint";
  const robot::CalibrationFile file = Run(options);
  ASSERT_EQ(file.moduli.size(), 1U);
  EXPECT_NEAR(file.moduli[0].youngs_modulus_Pa, 100e3,
              3.0 * file.moduli[0].standard_error_Pa + 100.0);
  ASSERT_TRUE(file.pose);
  EXPECT_TRUE(file.pose->T_robot_camera.isApprox(T_robot_camera_, 1e-3));
}

TEST_F(CalibrateCamera, DrawsHowBothWaysConverge) {
  CalibrateOptions options = Options();
  options.convergence = folder_ / "convergence.svg";
  Run(options);
  const std::string svg = ReadFile(options.convergence);
  EXPECT_THAT(svg, HasSubstr("Algorithm 1"));
  EXPECT_THAT(svg, HasSubstr("jointly"));
  int lines = 0;
  for (size_t at = 0; (at = svg.find("<polyline", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 2);

  folder_.Write("data/experiment.yaml", "frame: robot\nmarkers_sigma_m: 1.0e-4\n");
  options.what = "joint";
  EXPECT_THROW(Calibrate(options), InputError);
}

TEST_F(CalibrateCamera, AnotherRobotIsRefused) {
  std::string text = ReadFile(robot_);
  const std::string old = "[0.04, 0.02, 0.02]";
  text.replace(text.find(old), old.size(), "[0.07, 0.02, 0.02]");
  folder_.Write("bar.yaml", text);
  try {
    Calibrate(Options());
    FAIL() << "nothing was refused";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("another robot"));
  }
}

TEST_F(CalibrateCamera, TwoMarkersAreTooFew) {
  for (const char* name : {"hold_2", "hold_5", "hold_8"}) {
    folder_.Write(std::string("data/recordings/") + name + "/markers.csv",
                  "t_s,marker,x_m,y_m,z_m\n0.5,tip,0.1,0.2,0.3\n0.5,a,0.1,0.2,0.4\n");
  }
  EXPECT_THROW(Calibrate(Options()), RunError);
}

TEST_F(CalibrateCamera, ACameraThatMovedServesNot) {
  for (const char* name : {"hold_2", "hold_5", "hold_8"}) {
    folder_.Write(std::string("data/recordings/") + name + "/recording.yaml",
                  "kind: camera_moved\n");
  }
  CalibrateOptions options = Options();
  options.what = "camera";
  try {
    Calibrate(options);
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no recording determines the camera pose"));
  }
}

}  // namespace
}  // namespace palpate::command
