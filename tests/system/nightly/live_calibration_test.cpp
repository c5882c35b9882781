// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/system/calibration/calibration_listener.hpp"
#include "tests/system/virtual_bench.hpp"

/// palpate-calibration beside the running virtual bench, as its README has it: the
/// camera pose is known approximately only, until it is published.
namespace palpate::system_test {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

/// Three settings of the cables, over and over; the ball is far off. The body is of another
/// mesh than the model's.
const std::string kScenario =
    "name: settings\n" + test_support::BodyOfAnotherModulus("four_leg_coarse.msh") +
    test_support::kOffsetOfNorth + test_support::kBallBeforeASmallCamera + "recordings:\n" +
    test_support::Hold("H1", 2.0, {0.008, 0.004, 0.006, 0.007}) +
    test_support::Hold("H2", 2.0, {0.004, 0.009, 0.003, 0.008}) +
    test_support::Hold("H3", 2.0, {0.006, 0.005, 0.009, 0.004});

class LiveCalibration : public testing::Test {
 protected:
  LiveCalibration() {
    const std::filesystem::path config = std::filesystem::path(PALPATE_SOURCE_DIR) / "config";
    std::filesystem::copy_file(config / "scenarios/four_leg_coarse.msh",
                               folder_ / "four_leg_coarse.msh");
    WriteFile(folder_ / "settings.yaml", kScenario);
    truth_ =
        scenario::ReadScenario(folder_ / "settings.yaml", app::LoadYaml).camera->T_robot_camera;
    Eigen::Isometry3d rough = truth_;
    rough.translation() += Eigen::Vector3d(0.008, -0.006, 0.005);
    rough.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d(1.0, 1.0, 0.0).normalized()));
    robot_ = (config / "robots/four_leg.yaml").string();
    bench_ = std::make_unique<VirtualBench>(
        folder_, VirtualBench::Settings{.camera_address = "127.0.0.47",
                                        .scenario = folder_ / "settings.yaml",
                                        .robot_arguments = {"--set", "rate_hz=10"}});
    perception_ = std::make_unique<Process>(
        "palpate-perception",
        std::vector<std::string>{"--set", "robot_color_rgb=[0.85, 0.30, 0.25]"},
        folder_ / "perception.log");
    estimator_ = std::make_unique<Process>(
        "palpate-force-estimation", std::vector<std::string>{robot_, "--set", "source=shape"},
        folder_ / "force.log");
    calibration_ = std::make_unique<Process>(
        "palpate-calibration",
        std::vector<std::string>{robot_, "--out", file_.string(), "--camera-pose",
                                 geometry::FormatPose(rough), "--set", "at_start=true", "--set",
                                 "allow_contacts=true", "--set", "still_s=0.5", "--set",
                                 "frames=3"},
        folder_ / "calibration.log");
  }

  TestFolder folder_;
  std::filesystem::path file_ = folder_ / "calibration.yaml";
  std::string robot_;
  Eigen::Isometry3d truth_;
  Listener listener_;
  std::unique_ptr<VirtualBench> bench_;
  std::unique_ptr<Process> perception_, estimator_, calibration_;
};

TEST_F(LiveCalibration, FindsTheCameraWhichTheEstimatorTakes) {
  bench_->StartAll();
  ASSERT_TRUE(listener_.WaitForState("", "done")) << listener_.Story() << calibration_->Output();
  ASSERT_NE(listener_.Find("", "computing"), nullptr) << listener_.Story();
  EXPECT_EQ(listener_.Find("", "computing")->taken, 3u);
  ASSERT_TRUE(listener_.WaitFor([&] { return !listener_.found.empty(); }));
  ExpectRight(listener_.found[0], truth_);
  const robot::CalibrationFile file = robot::ReadCalibrationFile(file_, app::LoadYaml);
  EXPECT_EQ(file.data_hash, listener_.found[0].hash);
  EXPECT_TRUE(file.depth_bias);
  ASSERT_TRUE(listener_.WaitFor([&] {
    return !listener_.force_status.empty() && listener_.force_status != "no_calibration";
  })) << listener_.force_status
      << estimator_->Output();
  EXPECT_THAT(estimator_->Output(), HasSubstr("takes the calibration of " + file.date_utc));

  listener_.Ask("by_message", 3);
  ASSERT_TRUE(listener_.WaitForState("by_message", "done"))
      << listener_.Story() << calibration_->Output();
  ASSERT_TRUE(listener_.WaitFor([&] { return listener_.found.size() == 2; }));
  ExpectRight(listener_.found[1], truth_);

  listener_.Ask("interrupted", 2);
  ASSERT_TRUE(listener_.WaitForState("interrupted", "computing")) << listener_.Story();
  calibration_->Signal(SIGINT);
  EXPECT_EQ(calibration_->Wait(seconds(5)), 0) << calibration_->Output();
  EXPECT_EQ(listener_.Find("interrupted", "done"), nullptr);
  for (auto* process : {&estimator_, &perception_, &bench_->capture, &bench_->camera}) {
    (*process)->Signal(SIGTERM);
    EXPECT_EQ((*process)->Wait(kPatience), 0) << (*process)->Output();
  }
}

}  // namespace
}  // namespace palpate::system_test
