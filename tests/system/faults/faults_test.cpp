// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "libs/core/file.hpp"
#include "tests/system/faults/launched_system.hpp"
#include "tests/system/faults/system_listener.hpp"

/// Faults on command, and what all other processes say about them (docs/system_file.md).
namespace palpate::system_test::faults {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kPatience{40};

/// What is heard of a fault.
struct Heard {
  std::string what;  ///< for the message of a failure
  std::function<bool(SystemListener&)> is_heard;
};

bool Holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A component reports this status, with this in its reason.
Heard Says(const std::string& component, const std::string& status, const std::string& reason) {
  return {component + " says " + status + ": ..." + reason + "...", [=](SystemListener& listener) {
            const auto& report = listener.Of(component);
            return report.status == status && Holds(report.reason, reason);
          }};
}

/// A value of a component on /diagnostics holds this.
Heard Shows(const std::string& component, const std::string& key, const std::string& part) {
  return {component + " shows " + key + " ..." + part + "...", [=](SystemListener& listener) {
            const auto& values = listener.Of(component).values;
            const auto found = values.find(key);
            return found != values.end() && Holds(found->second, part);
          }};
}

/// The answers on /forces have this status and reason, and no force.
Heard NoForces(const std::string& status, const std::string& reason) {
  return {"/forces " + status + ": ..." + reason + "...", [=](SystemListener& listener) {
            const auto& last = listener.last();
            return last.status == status && Holds(last.reason, reason) && last.usable == 0;
          }};
}

/// Estimates go on, as old as that.
Heard ForcesOfAge(double age_s) {
  return {"/forces of an age of " + std::to_string(age_s) + " s", [=](SystemListener& listener) {
            return listener.estimates_in_a_row() >= 3 && listener.last().age_s >= age_s;
          }};
}

/// A component says that it cannot work, with a reason.
Heard SaysWhyNot(const std::string& component) {
  return {component + " says why it cannot work", [=](SystemListener& listener) {
            const auto& report = listener.Of(component);
            return report.count > 0 && report.status != "ok" && !report.reason.empty();
          }};
}

/// All that report still work, and say so.
Heard ForcesGoOn() {
  return {"/forces goes on", [](SystemListener& listener) {
            return listener.estimates_in_a_row() >= 20 && listener.Of("perception").count >= 2 &&
                   listener.Of("capture").status == "ok" &&
                   listener.Of("perception").status == "ok" &&
                   listener.Of("force_estimation").status == "ok";
          }};
}

class FaultsOnCommand : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ForcesCome()) << listener_.last() << "\n" << system_.launch().Output();
  }

  void TearDown() override {
    system_.launch().Signal(SIGINT);
    EXPECT_EQ(system_.launch().Wait(seconds(30)), 0) << system_.launch().Output();
    for (const char* trouble : {"failed", "signal 6", "signal 11"}) {
      EXPECT_FALSE(Holds(system_.launch().Output(), trouble)) << system_.launch().Output();
    }
  }

  bool ForcesCome() {
    listener_.Forget();
    return listener_.WaitFor([&] { return listener_.estimates_in_a_row() >= 3; }, 2 * kPatience);
  }

  int Fail(const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"fail"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const auto code = RunProgram("palpate", arguments, folder_ / "fail.log");
    return code.value_or(-1);
  }

  /// Makes the component faulty until all of `heard` is heard, and ends the fault: forces come
  /// again.
  void Expect(const std::string& component, const std::string& kind, std::vector<Heard> heard) {
    SCOPED_TRACE(component + " " + kind);
    std::vector<std::string> words{component, kind};
    if (kind == "slow") words.insert(words.end(), {"--delay", "1"});
    ASSERT_EQ(Fail(words), 0) << ReadFile(folder_ / "fail.log");
    heard.push_back(Shows(component, "fault_on_command", kind));
    listener_.Forget();
    for (const Heard& one : heard) {
      EXPECT_TRUE(listener_.WaitFor([&] { return one.is_heard(listener_); }, kPatience))
          << "not heard: " << one.what;
    }
    Print(component + " " + kind);
    ASSERT_EQ(Fail({component, "none"}), 0) << ReadFile(folder_ / "fail.log");
    EXPECT_TRUE(ForcesCome()) << listener_.last();
  }

  /// What all say, for the table in docs/system_file.md.
  void Print(const std::string& title) {
    std::ostringstream text;
    text << "== " << title << "\n  " << listener_.last() << "\n";
    for (const char* component :
         {"virtual_robot", "virtual_camera", "capture", "perception", "force_estimation"}) {
      text << "  " << component << ": " << listener_.Of(component) << "\n";
    }
    std::fputs(text.str().c_str(), stdout);
  }

  TestFolder folder_;
  SystemListener listener_;
  LaunchedSystem system_{folder_, {.camera_address = "127.0.0.62", .keys = "allow_faults: true\n"}};
};

TEST_F(FaultsOnCommand, OfCapture) {
  Expect("capture", "off",
         {Says("perception", "stale", "no depth images for"),
          Shows("perception", "waiting_for", "/camera/depth/image_raw"),
          Says("force_estimation", "stale", "no clouds for"), NoForces("stale", "no clouds for")});
  Expect(
      "capture", "stuck",
      {Says("perception", "stale", "pixel for pixel"),
       Says("force_estimation", "stale", "pixel for pixel"), NoForces("stale", "pixel for pixel")});
  Expect("capture", "slow", {Says("perception", "stale", "frames come 1"), ForcesOfAge(1.0)});
  const std::string misfit = "does not agree with the predicted robot";
  Expect("capture", "garbage",
         {Says("perception", "no_robot_seen", misfit),
          Says("force_estimation", "no_robot_seen", misfit), NoForces("no_robot_seen", misfit)});
  Expect("capture", "wrong",
         {Says("perception", "no_robot_seen", misfit), NoForces("no_robot_seen", "")});
}

TEST_F(FaultsOnCommand, OfPerception) {
  Expect("perception", "off",
         {Says("force_estimation", "stale", "no clouds for"),
          Shows("force_estimation", "waiting_for", "/perception/robot_cloud"),
          NoForces("stale", "no clouds for")});
  Expect("perception", "stuck",
         {Says("force_estimation", "stale", "bit for bit"), NoForces("stale", "bit for bit")});
  Expect("perception", "slow",
         {Says("force_estimation", "stale", "clouds come 1"), ForcesOfAge(1.0)});
  Expect("perception", "garbage",
         {Says("force_estimation", "invalid_input", ""), NoForces("invalid_input", "")});
}

TEST_F(FaultsOnCommand, OfPerceptionThatIsWrong) {
  Expect("perception", "wrong", {SaysWhyNot("force_estimation")});
}

/// Nobody computes with forces, and a model that is held looks like a robot that is still.
TEST_F(FaultsOnCommand, OfForceEstimation) {
  Expect("force_estimation", "off", {Shows("perception", "waiting_for", "/robot/mesh_state")});
  Expect("force_estimation", "stuck", {ForcesGoOn()});
  Expect("force_estimation", "slow", {Says("perception", "ok", "")});
  Expect("force_estimation", "garbage",
         {Says("perception", "invalid_input", "/robot/mesh_state refused")});
  Expect("force_estimation", "wrong", {Says("perception", "ok", "")});
}

TEST_F(FaultsOnCommand, OfTheVirtualRobot) {
  Expect(
      "virtual_robot", "off",
      {Says("virtual_camera", "stale", "no state of the virtual robot"),
       Says("capture", "stale", "no frame for"), Says("perception", "stale", "no depth images for"),
       Shows("force_estimation", "waiting_for", "/robot/joint_states"),
       NoForces("stale", "no clouds for")});
  Expect("virtual_robot", "stuck", {ForcesGoOn()});
  Expect("virtual_robot", "slow", {ForcesGoOn()});  // images and cable inputs are late together
  Expect("virtual_robot", "garbage",
         {Says("virtual_camera", "stale", "no state of the virtual robot"),
          NoForces("stale", "no clouds for")});
}

TEST_F(FaultsOnCommand, OfTheVirtualRobotThatIsWrong) {
  Expect("virtual_robot", "wrong", {SaysWhyNot("force_estimation")});
}

}  // namespace
}  // namespace palpate::system_test::faults
