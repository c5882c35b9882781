// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <Eigen/Core>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/system/virtual_bench.hpp"

/// The whole system as processes: a push from the camera's frames over GigE Vision to /forces,
/// perception that dies, joint states that stop.
namespace palpate::system_test::live_forces {
namespace {

using std::chrono::seconds;

constexpr seconds kPatience{40};

/// Ten frames a second, for machines that have other things to do; the ball holds to the end.
const std::string kScenario = "name: held\n" +
                              test_support::BodyOfAnotherModulus("four_leg_coarse.msh") +
                              test_support::kBallBeforeASmallCamera + test_support::kBallThatHolds;

struct Push {
  std::string name;
  Eigen::Vector3d position_m;
  Eigen::Vector3d force_N;
};

struct Answer {
  std::int64_t stamp_ns = 0;
  std::string status;
  std::string reason;
  std::vector<Push> pushes;
};

std::ostream& operator<<(std::ostream& stream, const Answer& answer) {
  stream << answer.status << " '" << answer.reason << "'";
  for (const Push& push : answer.pushes) {
    stream << ", " << push.name << " " << push.force_N.norm() << " N";
  }
  return stream;
}

Answer ToAnswer(const idl::palpate_msgs::ForceArray& message) {
  Answer answer{dds::StampNs(message.header.stamp),
                std::string(dds::Text(message.status)),
                std::string(dds::Text(message.reason)),
                {}};
  for (const auto& force : dds::Elements(message.forces)) {
    answer.pushes.push_back({std::string(dds::Text(force.name)),
                             {force.position_m.x, force.position_m.y, force.position_m.z},
                             {force.force_n.x, force.force_n.y, force.force_n.z}});
  }
  return answer;
}

/// Hears the estimates, the truth, and how the components fare.
class Listener {
 public:
  Listener()
      : node_("live_listener"),
        forces_(node_.participant.CreateReader(dds::kForcesTopic)),
        truth_(node_.participant.CreateReader(dds::kTrueForcesTopic)),
        statuses_(node_.participant.CreateReader(dds::kComponentStatusTopic)) {
    node_.loop.Attach(truth_, [this] {
      for (const auto& message : truth_.Take()) {
        Answer truth = ToAnswer(message);
        truths_[truth.stamp_ns] = std::move(truth.pushes);
      }
    });
    node_.loop.Attach(forces_, [this] {
      for (const auto& message : forces_.Take()) {
        last_ = ToAnswer(message);
        right_in_a_row_ = IsRight() ? right_in_a_row_ + 1 : 0;
      }
    });
    node_.loop.Attach(statuses_, [this] {
      for (const auto& message : statuses_.Take()) {
        heard_[std::string(dds::Text(message.component_name))] = true;
      }
    });
  }

  bool Heard(const std::string& component) const { return heard_.contains(component); }
  const Answer& last() const { return last_; }
  int right_in_a_row() const { return right_in_a_row_; }
  void Forget() {
    last_ = {};
    right_in_a_row_ = 0;
  }

  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return node_.loop.DispatchUntil(condition, dds::WaitSet::Clock::now() + kPatience);
  }

 private:
  static constexpr double kFarthest_m = 6e-3;
  static constexpr double kWorst = 0.25;
  static constexpr std::int64_t kSameTime_ns = 150'000'000;

  /// One push, with a contact's name, where the true one is and about as hard.
  bool IsRight() const {
    const std::vector<Push>* truth = TruthAt(last_.stamp_ns);
    if (last_.status != "ok" || last_.pushes.size() != 1 || !truth || truth->size() != 1) {
      return false;
    }
    const Push& push = last_.pushes[0];
    const Push& is = truth->front();
    return (push.name.starts_with("contact_") || push.name.starts_with("hidden_")) &&
           (push.position_m - is.position_m).norm() <= kFarthest_m &&
           std::abs(push.force_N.norm() - is.force_N.norm()) <= kWorst * is.force_N.norm();
  }
  const std::vector<Push>* TruthAt(std::int64_t stamp_ns) const {
    const auto after = truths_.lower_bound(stamp_ns - kSameTime_ns);
    return after == truths_.end() || after->first > stamp_ns + kSameTime_ns ? nullptr
                                                                            : &after->second;
  }

  dds::TestNode node_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::ForceArray> truth_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  std::map<std::int64_t, std::vector<Push>> truths_;
  std::map<std::string, bool> heard_;
  Answer last_;
  int right_in_a_row_ = 0;
};

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
  Listener listener_;
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
    EXPECT_EQ((*process)->Wait(kPatience), 0) << (*process)->Output();
  }
}

}  // namespace
}  // namespace palpate::system_test::live_forces
