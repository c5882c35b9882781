// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/node.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/player/sample_experiment.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::player {
namespace {

using dds::TestNode;
using idl::palpate_msgs::ForceArray;
using idl::palpate_msgs::MarkerArray3;
using idl::sensor_msgs::JointState;

constexpr Playback kFast{.rate = std::numeric_limits<double>::infinity()};
constexpr Playback kStep{.step = true};

/// Notes every frame and, where asked, answers it on /forces as the estimator does.
class FakeEstimator {
 public:
  explicit FakeEstimator(bool answers)
      : node_("fake_estimator"),
        forces_(node_.participant.CreateWriter(dds::kForcesTopic)),
        joint_states_(node_.participant.CreateReader(dds::kJointStatesTopic)),
        markers_(node_.participant.CreateReader(dds::kMarkersTopic)) {
    node_.loop.Attach(joint_states_, [this] { TakeJointStates(); });
    node_.loop.Attach(markers_, [this, answers] { TakeMarkers(answers); });
  }

  TestNode& node() { return node_; }
  const std::vector<std::string>& frames() const { return frames_; }
  /// Frames that came without a joint state of the same stamp before them.
  int frames_without_cables() const { return frames_without_cables_; }
  /// Leaves every so many-th frame unanswered when it comes first.
  void Ignore(uint64_t counter) { ignored_ = counter; }

 private:
  void TakeJointStates() {
    for (const JointState& state : joint_states_.Take()) {
      last_cables_ns_ = dds::StampNs(state.header.stamp);
    }
  }

  void TakeMarkers(bool answers) {
    TakeJointStates();
    for (const MarkerArray3& markers : markers_.Take()) {
      const std::string recording(dds::Text(markers.recording));
      frames_.push_back(recording + std::to_string(markers.counter));
      const int64_t stamp_ns = dds::StampNs(markers.header.stamp);
      if (last_cables_ns_ != stamp_ns) ++frames_without_cables_;
      if (!answers || ignored_ == markers.counter) {
        ignored_.reset();
        continue;
      }
      dds::Message<ForceArray> forces;
      dds::SetHeader(forces->header, stamp_ns, "robot");
      dds::SetText(forces->recording, recording);
      EXPECT_TRUE(forces_.Write(forces));
    }
  }

  TestNode node_;
  dds::Writer<ForceArray> forces_;
  dds::Reader<JointState> joint_states_;
  dds::Reader<MarkerArray3> markers_;
  std::vector<std::string> frames_;
  int64_t last_cables_ns_ = -1;
  int frames_without_cables_ = 0;
  std::optional<uint64_t> ignored_;
};

/// A player in a thread of its own.
class RunningPlayer {
 public:
  RunningPlayer(const NodeConfig& config, const Playback& playback)
      : node_(config, playback, ExperimentPlayer(SampleExperiment(), "", true),
              static_cast<int>(dds::TestDomain()), dds::BuiltInTable(), {}),
        thread_([this] { Run(); }) {}
  ~RunningPlayer() {
    node_.Stop();
    thread_.join();
  }

  bool finished() const { return finished_; }
  const std::string& error() const { return error_; }  ///< after finished()
  PlayerNode& node() { return node_; }

 private:
  void Run() {
    try {
      node_.Run();
    } catch (const RunError& error) {
      error_ = error.what();
    }
    finished_ = true;
  }

  PlayerNode node_;
  std::string error_;
  std::atomic<bool> finished_ = false;
  std::thread thread_;
};

/// Lets the estimator work until the player has finished.
void WaitUntilFinished(const RunningPlayer& player, TestNode& node) {
  node.loop.Every(std::chrono::milliseconds(5), [] {});
  ASSERT_TRUE(node.WaitFor([&] { return player.finished(); }));
}

const std::vector<std::string> kAllFrames{"a0", "a1", "a2", "a3", "b0", "b1", "b2", "b3"};

TEST(PlayerNode, InStepsEachFrameArrivesOnceAfterItsCableInputs) {
  FakeEstimator estimator(true);
  RunningPlayer player({}, kStep);
  WaitUntilFinished(player, estimator.node());
  EXPECT_EQ(player.error(), "");
  EXPECT_EQ(estimator.frames(), kAllFrames);
  EXPECT_EQ(estimator.frames_without_cables(), 0);
}

TEST(PlayerNode, SendsAFrameAgainThatIsNotAnswered) {
  FakeEstimator estimator(true);
  estimator.Ignore(2);
  NodeConfig config;
  config.resend_s = 0.05;
  RunningPlayer player(config, kStep);
  WaitUntilFinished(player, estimator.node());
  EXPECT_THAT(estimator.frames(), testing::IsSupersetOf(kAllFrames));
  EXPECT_GT(estimator.frames().size(), kAllFrames.size());
}

TEST(PlayerNode, PlaysToListenersThatNeverAnswer) {
  FakeEstimator listener(false);
  RunningPlayer player({}, kFast);
  ASSERT_TRUE(listener.node().WaitFor(
      [&] { return !listener.frames().empty() && listener.frames().back() == "b3"; }));
}

TEST(PlayerNode, GivesUpWhereNobodyListens) {
  NodeConfig config;
  config.reader_deadline_s = 0.05;
  RunningPlayer player(config, kFast);
  TestNode bystander("bystander");
  WaitUntilFinished(player, bystander);
  EXPECT_THAT(player.error(), testing::HasSubstr("no reader of /perception/markers"));
}

TEST(PlayerNode, GivesUpWhereAFrameIsNotAnswered) {
  FakeEstimator estimator(false);
  NodeConfig config;
  config.step_deadline_s = 0.1;
  config.resend_s = 0.02;
  RunningPlayer player(config, kStep);
  WaitUntilFinished(player, estimator.node());
  EXPECT_THAT(player.error(), testing::HasSubstr("no answer on /forces to the frame at 0 s"));
}

TEST(PlayerNode, BeginsTheRecordingAgainForAnEstimatorThatWasRestarted) {
  auto first = std::make_unique<FakeEstimator>(true);
  first->Ignore(2);
  NodeConfig config;
  config.resend_s = 30.0;
  RunningPlayer player(config, kStep);
  ASSERT_TRUE(first->node().WaitFor([&] { return first->frames().size() == 3; }));
  first.reset();  // died before it answered the third frame

  FakeEstimator second(true);
  WaitUntilFinished(player, second.node());
  EXPECT_EQ(player.error(), "");
  EXPECT_EQ(second.frames(), kAllFrames);
}

TEST(PlayerNode, StopsInTheMiddleOfARecording) {
  FakeEstimator estimator(false);
  RunningPlayer player({}, kStep);
  ASSERT_TRUE(estimator.node().WaitFor([&] { return !estimator.frames().empty(); }));
  player.node().Stop();
  WaitUntilFinished(player, estimator.node());
  EXPECT_EQ(player.error(), "");
}

/// What a node with use_sim_time takes for now, in the order of its coming.
class ClockListener {
 public:
  explicit ClockListener(TestNode& node)
      : reader_(node.participant.CreateReader(dds::kClockTopic)) {
    node.loop.Attach(reader_, [this] {
      for (const auto& message : reader_.Take()) times_ns_.push_back(dds::StampNs(message.clock));
    });
  }
  const std::vector<int64_t>& times_ns() const { return times_ns_; }

 private:
  dds::Reader<idl::rosgraph_msgs::Clock> reader_;
  std::vector<int64_t> times_ns_;
};

TEST(PlayerNode, InStepsTheClockIsTheStampOfTheFrame) {
  FakeEstimator estimator(true);
  ClockListener clock(estimator.node());
  NodeConfig config;
  config.publish_clock = true;
  RunningPlayer player(config, kStep);
  WaitUntilFinished(player, estimator.node());
  ASSERT_TRUE(estimator.node().WaitFor(
      [&] { return !clock.times_ns().empty() && clock.times_ns().back() == 300'000'000; }));
  for (const int64_t time_ns : clock.times_ns()) EXPECT_EQ(time_ns % 50'000'000, 0) << time_ns;
}

TEST(PlayerNode, InRealTimeTheClockRunsBetweenTheFrames) {
  FakeEstimator listener(false);
  ClockListener clock(listener.node());
  NodeConfig config;
  config.publish_clock = true;
  RunningPlayer player(config, {.rate = 1.0});
  WaitUntilFinished(player, listener.node());
  int between = 0;
  int64_t last_ns = 0;
  int begins = 0;
  for (const int64_t time_ns : clock.times_ns()) {
    between += time_ns % 50'000'000 != 0 ? 1 : 0;
    begins += time_ns < last_ns ? 1 : 0;  // the second recording begins again from 0
    last_ns = time_ns;
    EXPECT_LE(time_ns, 300'000'000);
  }
  EXPECT_GT(between, 5);
  EXPECT_EQ(begins, 1);
}

TEST(PlayerNode, WithoutTheSettingThereIsNoClock) {
  FakeEstimator estimator(true);
  ClockListener clock(estimator.node());
  RunningPlayer player({}, kStep);
  WaitUntilFinished(player, estimator.node());
  EXPECT_TRUE(clock.times_ns().empty());
}

}  // namespace
}  // namespace palpate::player
