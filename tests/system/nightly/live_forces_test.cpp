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

/// The whole system as processes: a push from the camera's frames over GigE Vision to /forces,
/// perception that dies, joint states that stop.
namespace palpate::system_test::live_forces {
namespace {

/// Ten frames a second, for machines that have other things to do; the ball holds to the end.
const std::string kScenario = "name: held\n" +
                              test_support::BodyOfAnotherModulus("four_leg_coarse.msh") +
                              test_support::kBallBeforeASmallCamera + test_support::kBallThatHolds;

class LiveForces : public testing::Test {
 protected:
  LiveForces() {
    const std::filesystem::path config = std::filesystem::path(PALPATE_SOURCE_DIR) / "config";
    std::filesystem::copy_file(config / "scenarios/four_leg_coarse.msh",
                               folder_ / "four_leg_coarse.msh");
    WriteFile(folder_ / "held.yaml", kScenario);
    pose_ = geometry::FormatPose(
        scenario::ReadScenario(folder_ / "held.yaml", app::LoadYaml).camera->T_robot_camera);
    bench_ = std::make_unique<VirtualBench>(
        folder_, VirtualBench::Settings{.camera_address = "127.0.0.46",
                                        .scenario = folder_ / "held.yaml",
                                        .robot_arguments = {"--set", "rate_hz=10"}});
    estimator_ = std::make_unique<Process>(
        "palpate-force-estimation",
        std::vector<std::string>{(config / "robots/four_leg.yaml").string(), "--camera-pose", pose_,
                                 "--set", "shape.untouched_frames=8", "--set", "silence_s=1"},
        folder_ / "force.log");
    StartPerception();
  }

  void StartPerception() {
    perception_ = std::make_unique<Process>("palpate-perception",
                                            std::vector<std::string>{"--camera-pose", pose_},
                                            folder_ / "perception.log");
  }

  /// A topic table by which the robot's joint states have no matching reader: readers request more
  /// than it offers.
  std::string DeafTopics() {
    std::string text = ReadFile(std::filesystem::path(PALPATE_SOURCE_DIR) / "config/topics.yaml");
    const std::string reliable = "reliability: reliable";
    text.replace(text.find(reliable, text.find("/robot/joint_states")), reliable.size(),
                 "reliability: best_effort");
    WriteFile(folder_ / "deaf.yaml", text);
    return (folder_ / "deaf.yaml").string();
  }

  bool WaitForPush() {
    listener_.Forget();
    return listener_.WaitFor([&] { return listener_.right_in_a_row() >= 3; });
  }
  bool WaitForStale(const std::string& reason) {
    return listener_.WaitFor([&] {
      return listener_.last().status == "stale" &&
             listener_.last().reason.find(reason) != std::string::npos;
    });
  }

  TestFolder folder_;
  std::string pose_;
  ForceListener listener_;
  std::unique_ptr<VirtualBench> bench_;
  std::unique_ptr<Process> estimator_;
  std::unique_ptr<Process> perception_;
};

TEST_F(LiveForces, AreFoundAndWhatStopsIsSaid) {
  bench_->StartCamera();
  bench_->StartCapture();
  ASSERT_TRUE(listener_.WaitFor([&] {
    return listener_.Heard("capture") && listener_.Heard("perception") &&
           listener_.Heard("force_estimation");
  }));
  bench_->StartRobot();
  ASSERT_TRUE(WaitForPush()) << listener_.last() << estimator_->Output();

  bench_->Kill(perception_);
  EXPECT_TRUE(WaitForStale("no clouds for")) << listener_.last();
  StartPerception();
  ASSERT_TRUE(WaitForPush()) << listener_.last() << perception_->Output();

  bench_->Kill(bench_->robot);
  bench_->StartRobot({"--set", "dds.topics_file=" + DeafTopics()});
  EXPECT_TRUE(WaitForStale("the cable inputs are")) << listener_.last();
  EXPECT_TRUE(listener_.last().pushes.empty());
  bench_->Kill(bench_->robot);
  bench_->StartRobot();
  ASSERT_TRUE(WaitForPush()) << listener_.last() << estimator_->Output();

  for (auto* process : {&estimator_, &perception_, &bench_->capture, &bench_->camera}) {
    (*process)->Signal(SIGTERM);
    EXPECT_EQ((*process)->Wait(kForcesPatience), 0) << (*process)->Output();
  }
}

}  // namespace
}  // namespace palpate::system_test::live_forces
