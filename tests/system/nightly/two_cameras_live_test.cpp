// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/system/nightly/force_listener.hpp"
#include "tests/system/virtual_bench.hpp"

/// Two depth cameras as processes: a push that only the second one sees is found, and estimates go
/// on where the second one is gone.
namespace palpate::system_test::two_cameras {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Opposite the first.
const std::string kBackCamera = R"(cameras:
  - name: back
    depth: {width_px: 424, height_px: 240, fx_px: 212, fy_px: 212, cx_px: 211.5, cy_px: 119.5,
            unit_m: 0.0001, baseline_m: 0.05}
    color: {width_px: 424, height_px: 240, fx_px: 212, fy_px: 212, cx_px: 211.5, cy_px: 119.5,
            registered_to_depth: true}
    eye_m: [-0.343, 0.198, 0.275]
    target_m: [0, 0, 0.065]
    rate_hz: 10
    noise: {sensor: stereo}
)";

/// The ball presses the flank that the first camera does not see.
const std::string kBallBehind = R"(recordings:
  - name: press
    kind: free
    duration_s: 200
    commands: [{t_s: 0, east.displacement_m: 0}, {t_s: 200, east.displacement_m: 0}]
    tools:
      - tool: ball
        path:
          - {t_s: 20, position_m: [-0.0560, 0.0560, 0.103]}
          - {t_s: 21, position_m: [-0.0285, 0.0285, 0.103]}
          - {t_s: 22, position_m: [-0.0220, 0.0220, 0.103]}
          - {t_s: 200, position_m: [-0.0220, 0.0220, 0.103]}
)";

class TwoCameraProcesses : public testing::Test {
 protected:
  static constexpr auto kFrontAddress = "127.0.0.71";
  static constexpr auto kBackAddress = "127.0.0.72";

  TwoCameraProcesses() {
    std::filesystem::copy_file(config_ / "scenarios/four_leg_coarse.msh",
                               folder_ / "four_leg_coarse.msh");
    WriteFile(folder_ / "behind.yaml",
              "name: behind\n" + test_support::BodyOfAnotherModulus("four_leg_coarse.msh") +
                  test_support::kBallBeforeASmallCamera + kBackCamera + kBallBehind);
    const auto scenario = scenario::ReadScenario(folder_ / "behind.yaml", app::LoadYaml);
    const std::string front = geometry::FormatPose(scenario.camera->T_robot_camera);
    const std::string back =
        "back: " + geometry::FormatPose(scenario.further_cameras.at(0).T_robot_camera);
    // One text for each camera: a setting that is a list takes YAML.
    const std::string cameras = "cameras=['" + back + "']";
    bench_ = std::make_unique<VirtualBench>(
        folder_, VirtualBench::Settings{.camera_address = kFrontAddress,
                                        .scenario = folder_ / "behind.yaml",
                                        .robot_arguments = {"--set", "rate_hz=10"}});
    estimator_ = Start("palpate-force-estimation",
                       {robot_, "--camera-pose", front, "--set", cameras, "--set",
                        "shape.untouched_frames=15", "--set", "silence_s=2"});
    // On a slow machine images of one time come far apart.
    perception_ = Start("palpate-perception",
                        {"--camera-pose", front, "--set", cameras, "--set", "camera_wait_s=1"});
    capture_ = Start("palpate-capture", {"--set", "camera_name=back", "--set",
                                         std::string("genicam.camera_id=") + kBackAddress});
    camera_ = Start("palpate-virtual-camera",
                    {robot_, "--scenario", (folder_ / "behind.yaml").string(), "--seed", "7",
                     "--set", "camera_name=back", "--set", "serial=VC000002", "--set",
                     std::string("interface_address=") + kBackAddress});
  }

  std::unique_ptr<Process> Start(const std::string& program,
                                 const std::vector<std::string>& arguments) {
    return std::make_unique<Process>(program, arguments,
                                     folder_ / (program + std::to_string(logs_++) + ".log"));
  }

  const std::filesystem::path config_ = std::filesystem::path(PALPATE_SOURCE_DIR) / "config";
  const std::string robot_ = (config_ / "robots/four_leg.yaml").string();
  TestFolder folder_;
  int logs_ = 0;
  ForceListener listener_;
  std::unique_ptr<VirtualBench> bench_;
  std::unique_ptr<Process> estimator_, perception_, capture_, camera_;
};

TEST_F(TwoCameraProcesses, FindWhatOnlyTheSecondSeesAndGoOnWithoutIt) {
  bench_->StartCamera();
  bench_->StartCapture();
  ASSERT_TRUE(listener_.WaitFor([&] {
    return listener_.Heard("capture") && listener_.Heard("capture_back") &&
           listener_.Heard("perception") && listener_.Heard("force_estimation");
  })) << capture_->Output();
  bench_->StartRobot();
  ASSERT_TRUE(listener_.WaitFor([&] { return listener_.right_in_a_row() >= 3; }))
      << listener_.last() << estimator_->Output() << perception_->Output();
  EXPECT_THAT(listener_.last().pushes.at(0).name, HasSubstr("contact_")) << "it is seen";
  EXPECT_THAT(listener_.notes(), Not(Contains(HasSubstr("camera 'back'"))));

  bench_->Kill(camera_);
  ASSERT_TRUE(listener_.WaitFor(
      [&] { return testing::Value(listener_.notes(), Contains(HasSubstr("camera 'back'"))); }));
  for (int frame = 0; frame < 20; ++frame) {
    listener_.Forget();
    ASSERT_TRUE(listener_.WaitFor([&] { return listener_.answers() > 0; }));
    const std::string& status = listener_.last().status;
    EXPECT_TRUE(status == "ok" || status == "no_contact") << listener_.last();
    EXPECT_THAT(listener_.notes(), Contains(HasSubstr("camera 'back'")));
  }
  for (auto* process : {&estimator_, &perception_, &capture_, &bench_->capture, &bench_->camera}) {
    (*process)->Signal(SIGTERM);
    EXPECT_EQ((*process)->Wait(kForcesPatience), 0) << (*process)->Output();
  }
}

}  // namespace
}  // namespace palpate::system_test::two_cameras
