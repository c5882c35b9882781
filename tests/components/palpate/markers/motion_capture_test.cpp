// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/file.hpp"
#include "tests/components/palpate/markers/marked_bar.hpp"
#include "tests/libs/experiment/c3d_writer.hpp"

/// The whole way of motion capture: a C3D file, `palpate import`, `palpate calibrate`. The frame of
/// the motion capture stands anywhere to the robot (T_robot_camera_).
namespace palpate::command {
namespace {

using experiment::C3dContent;
using experiment::C3dProcessor;
using testing::HasSubstr;

class MotionCapture : public MarkedBar {
 protected:
  /// 40 frames in mm with 0.1 mm of noise; a marker of each is hidden for a while.
  std::filesystem::path WriteCapture(const BarSight& sight, C3dProcessor processor, bool real) {
    C3dContent content;
    content.processor = processor;
    content.real_points = real;
    if (!real) content.scale = 0.02;  // 16 bits hold 0.65 m
    const Points points = See(sight);
    std::normal_distribution<double> noise(0.0, 0.1);
    for (const auto& [name, at_m] : points) content.labels.push_back(name);
    for (int frame = 0; frame < 40; ++frame) {
      std::vector<C3dContent::Point>& row = content.frames.emplace_back();
      for (const auto& [name, at_m] : points) {
        row.push_back({.x = 1e3 * at_m.x() + noise(random_),
                       .y = 1e3 * at_m.y() + noise(random_),
                       .z = 1e3 * at_m.z() + noise(random_)});
      }
      row[static_cast<std::size_t>(frame) / 8].seen = frame % 8 == 0;
    }
    return folder_.Write(sight.name + ".c3d", experiment::WriteC3d(content));
  }

  void Import(BarSight sight, C3dProcessor processor, bool real,
              const std::vector<std::string>& more = {}) {
    const auto file = WriteCapture(sight, processor, real);
    std::vector<std::string> words = {
        "import",      file.string(), "--out",  (folder_ / "data").string(),
        "--recording", sight.name,    "--kind", "hold"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = Run(words);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("12 markers, 40 frames at 50 Hz"));
    WriteInputs(sight);  // what the drives were set to comes from elsewhere
  }

  /// One in each byte order and number format.
  void ImportThree(bool names, const std::vector<std::string>& more = {}) {
    Import({.name = "a", .commanded_m = 0.002, .names = names}, C3dProcessor::kIntel, true, more);
    Import({.name = "b", .commanded_m = 0.005, .names = names}, C3dProcessor::kDec, true, more);
    Import({.name = "c", .commanded_m = 0.008, .names = names}, C3dProcessor::kMips, false, more);
  }
};

TEST_F(MotionCapture, FindsTheRigidMotionBetweenItsFrameAndTheRobot) {
  ImportThree(true, {"--robot", robot_.string()});
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ExpectPose();
  EXPECT_NEAR(Found().drives.at(0).drive.offset_m, kOffset_m,
              4.0 * Found().drives[0].standard_error.offset_m);
  EXPECT_LT(Found().residual_rms_m, 3e-4);
}

TEST_F(MotionCapture, PointsWithoutLabelsAreToldApartByWhereTheyAre) {
  ImportThree(false, {"--robot", robot_.string()});
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  for (const std::string name : {"a", "b", "c"}) {
    EXPECT_THAT(run.output, HasSubstr(name + ": 12 of 12 markers seen, 0 points are none"));
  }
  ExpectPose();
  EXPECT_LT(Found().residual_rms_m, 3e-4);
}

TEST_F(MotionCapture, AMirroredAxisIsRefused) {
  for (const char* name : {"a", "b"}) {
    Import({.name = name,
            .commanded_m = 0.004,
            .spoil = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.y(), p.x(), p.z()); }},
           C3dProcessor::kIntel, true);
  }
  ExpectFailure(Calibrate(), "mirror");
}

}  // namespace
}  // namespace palpate::command
