// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>

#include "libs/core/error.hpp"
#include "libs/dds/clock_offsets.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/peers.hpp"
#include "libs/dds/qos.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/dds/sole_writers.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

using ::testing::HasSubstr;
using SteadyClock = std::chrono::steady_clock;

ProcessIdentity Elsewhere() {
  return {.host = {"other-boot", "lab2"},
          .program = "palpate-force-estimation",
          .process_id = 4711,
          .process_namespace = "pid:[1]",
          .start_ns = 1,
          .messages = MessagesHash()};
}

TEST(Peers, UserDataTellTheProcess) {
  const ProcessIdentity told = Elsewhere();
  const auto read = FromUserData("enclave=/;" + ToUserData(told));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->host.id, told.host.id);
  EXPECT_EQ(read->host.name, told.host.name);
  EXPECT_EQ(read->program, told.program);
  EXPECT_EQ(read->process_id, told.process_id);
  EXPECT_EQ(read->process_namespace, told.process_namespace);
  EXPECT_EQ(read->start_ns, told.start_ns);
  EXPECT_EQ(read->messages, told.messages);
  EXPECT_FALSE(FromUserData("enclave=/;"));
  EXPECT_FALSE(FromUserData("palpate=a,b;"));
  EXPECT_FALSE(FromUserData("palpate=a,b,c,d,e,f,g;"));
}

TEST(Peers, AProcessThatHasEndedHereDoesNotRun) {
  ProcessIdentity process = ThisProcess();
  EXPECT_TRUE(MayRun(process));
  process.process_id = 0x7FFFFFF;  // above the kernel's largest
  EXPECT_FALSE(MayRun(process));
  process.process_namespace = "pid:[1]";
  EXPECT_TRUE(MayRun(process));
  EXPECT_TRUE(MayRun(Elsewhere()));
}

TEST(Peers, FindsTheProcessesOfTheDomain) {
  TestNode one("one");
  TestNode other("other");
  Peers peers(one.participant.handle());
  one.loop.Every(std::chrono::milliseconds(20), [&] { peers.Update(); });
  ASSERT_TRUE(one.WaitFor([&] { return peers.all().size() >= 2; }));
  for (const auto& [guid, process] : peers.all()) {
    ASSERT_TRUE(process);
    EXPECT_EQ(process->process_id, getpid());
    EXPECT_EQ(process->messages, MessagesHash());
  }
}

/// A process of another host whose clock is 2.5 s ahead.
TEST(ClockOffsets, MeasuresTheClockOfAnotherHost) {
  constexpr std::int64_t kAhead_ns = 2'500'000'000;
  TestNode here("here");
  TestNode there("there");
  ClockOffsets own(here.participant, {"a", "lab1"});
  ClockOffsets other(there.participant, {"b", "lab2"}, [] { return WallNow_ns() + kAhead_ns; });
  here.loop.Every(std::chrono::milliseconds(20), [&] {
    own.Send({});
    other.Send({"/camera/frame_info"});
  });
  ASSERT_TRUE(here.WaitFor([&] { return !own.All().empty() && !other.All().empty(); }));
  const HostClock clock = own.All().front();
  EXPECT_EQ(clock.host.name, "lab2");
  EXPECT_NEAR(clock.offset.offset_s, 2.5, clock.offset.bound_s);
  EXPECT_LT(clock.offset.bound_s, 1.0);
  EXPECT_NEAR(other.All().front().offset.offset_s, -2.5, other.All().front().offset.bound_s);
  ASSERT_TRUE(own.Of("/camera/frame_info"));
  EXPECT_NEAR(own.Of("/camera/frame_info")->offset_s, 2.5, clock.offset.bound_s + 1.0);
  EXPECT_EQ(other.Of("/camera/frame_info")->offset_s, 0.0);
  EXPECT_FALSE(own.Of("/robot/joint_states"));
}

/// Sending while messages come, and processes join and leave, locks nobody out.
TEST(ClockOffsets, SendsWhileMessagesComeAndProcessesLeave) {
  TestNode here("here");
  ClockOffsets own(here.participant, {"a", "lab1"});
  std::atomic<bool> stop{false};
  std::thread sender([&] {
    while (!stop) own.Send({});
  });
  for (int i = 0; i < 5; ++i) {
    TestNode there("there");
    ClockOffsets other(there.participant, {"b", "lab2"});
    there.loop.Every(std::chrono::milliseconds(1), [&] { other.Send({}); });
    EXPECT_TRUE(there.WaitFor([&] { return !other.All().empty(); }));
  }
  stop = true;
  sender.join();
}

TEST(ClockOffsets, ProcessesOfOneHostHaveOneClock) {
  TestNode here("here");
  TestNode there("there");
  ClockOffsets own(here.participant, {"a", "lab1"});
  ClockOffsets other(there.participant, {"a", "lab1"});
  here.loop.Every(std::chrono::milliseconds(20), [&] {
    own.Send({});
    other.Send({"/robot/joint_states"});
  });
  ASSERT_TRUE(here.WaitFor([&] { return own.Of("/robot/joint_states").has_value(); }));
  EXPECT_EQ(own.Of("/robot/joint_states")->offset_s, 0.0);
  EXPECT_TRUE(own.All().empty());
}

TEST(RosClock, AgesAreByTheClockThatStampsTheFrames) {
  RosClock clock;
  clock.SetOffsets(3'000'000'000, 1'000'000'000);
  EXPECT_NEAR(1e-9 * static_cast<double>(clock.NowOfFrames_ns() - clock.Now_ns()), 3.0, 1.0);
  EXPECT_EQ(clock.CableStampOfFrames_ns(5), 2'000'000'005);
}

/// A camera's host that is 2.5 s ahead, and a robot's driver there.
TEST(HealthReporter, GivesTheNodeTheClockOfTheFrames) {
  constexpr std::int64_t kAhead_ns = 2'500'000'000;
  TestNode model("model");
  TestNode camera("camera");
  HealthReporter health(model.participant, "force_estimation", SteadyClock::now());
  ClockOffsets other(camera.participant, {"b", "lab2"}, [] { return WallNow_ns() + kAhead_ns; });
  RosClock& clock = *model.participant.clock();
  const auto ahead_s = [&] {
    return 1e-9 * static_cast<double>(clock.NowOfFrames_ns() - clock.Now_ns());
  };
  model.loop.Every(std::chrono::milliseconds(20), [&] {
    health.Report(Status::Ok(), {}, {}, SteadyClock::now());
    other.Send({"/camera/frame_info"});
  });
  ASSERT_TRUE(model.WaitFor([&] { return std::abs(ahead_s()) > 1.0; }));
  EXPECT_NEAR(ahead_s(), 2.5, 0.5);
  // The clock of the cable inputs is not known.
  EXPECT_EQ(clock.CableStampOfFrames_ns(5), 5);
  auto cables = model.participant.CreateWriter(kJointStatesTopic);
  ASSERT_TRUE(model.WaitFor([&] { return clock.CableStampOfFrames_ns(5) != 5; }));
  EXPECT_NEAR(1e-9 * static_cast<double>(clock.CableStampOfFrames_ns(0)), 2.5, 0.5);
}

/// It stays where the host is gone: frames of further cameras are on that clock, too.
TEST(HealthReporter, KeepsTheClockOfTheFramesWhereItsHostIsGone) {
  constexpr std::int64_t kAhead_ns = 2'500'000'000;
  TestNode model("model");
  HealthReporter health(model.participant, "force_estimation", SteadyClock::now());
  RosClock& clock = *model.participant.clock();
  const auto ahead_s = [&] {
    return 1e-9 * static_cast<double>(clock.NowOfFrames_ns() - clock.Now_ns());
  };
  std::optional<ClockOffsets> other;
  std::optional<TestNode> camera;
  camera.emplace("camera");
  other.emplace(camera->participant, Host{"b", "lab2"}, [] { return WallNow_ns() + kAhead_ns; });
  model.loop.Every(std::chrono::milliseconds(20), [&] {
    health.Report(Status::Ok(), {}, {}, SteadyClock::now());
    // In place of the host that is gone: one that stamps nothing.
    other->Send(camera ? std::vector<std::string>{"/camera/frame_info"}
                       : std::vector<std::string>());
  });
  ASSERT_TRUE(model.WaitFor([&] { return ahead_s() > 1.0; }));
  TestNode after("after");
  other.emplace(after.participant, Host{"c", "lab3"});
  camera.reset();
  int reports = 0;
  model.loop.Every(std::chrono::milliseconds(20), [&] { ++reports; });
  ASSERT_TRUE(model.WaitFor([&] { return reports > 20; }));
  EXPECT_NEAR(ahead_s(), 2.5, 0.5);
}

TEST(HealthReporter, KnowsWhichClockStampsATopic) {
  constexpr std::int64_t kAhead_ns = 2'500'000'000;
  TestNode here("here");
  setenv("PALPATE_HOST", "lab2", 1);
  TestNode there("there");
  unsetenv("PALPATE_HOST");
  HealthReporter health(here.participant, "perception", SteadyClock::now());
  ClockOffsets other(there.participant, {"lab2", "lab2"}, [] { return WallNow_ns() + kAhead_ns; });
  TestNode near("near");
  const auto far_images = there.participant.CreateWriter(kDepthImageTopic);
  const auto near_infos = near.participant.CreateWriter(kFrameInfoTopic);
  EXPECT_FALSE(health.ClockOf("/robot/joint_states"));
  here.loop.Every(std::chrono::milliseconds(20), [&] {
    health.Report(Status::Ok(), {}, {}, SteadyClock::now());
    other.Send({});
  });
  std::optional<StampClock> far, own;
  ASSERT_TRUE(here.WaitFor([&] {
    far = health.ClockOf("/camera/depth/image_raw");
    own = health.ClockOf("/camera/frame_info");
    return far && far->offset && own;
  }));
  EXPECT_EQ(far->host.name, "lab2");
  EXPECT_NEAR(far->offset->offset_s, 2.5, far->offset->bound_s + 1e-3);
  EXPECT_EQ(own->host.id, ThisHost().id);
  ASSERT_TRUE(own->offset);
  EXPECT_EQ(own->offset->offset_s, 0.0);
}

/// A participant that says it is `process`, with a writer of /forces.
struct OtherProcess {
  explicit OtherProcess(const ProcessIdentity& process, const std::string& ros_name = "/forces") {
    const std::string user_data = "enclave=/;" + ToUserData(process);
    const Qos participant_qos(dds_create_qos());
    dds_qset_userdata(participant_qos.get(), user_data.data(), user_data.size());
    participant = Entity(dds_create_participant(TestDomain(), participant_qos.get(), nullptr), "p");
    const auto& type = idl::MessageTraits<idl::palpate_msgs::ForceArray>::Descriptor();
    topic = Entity(dds_create_topic(participant.handle(), &type, DdsTopicName(ros_name).c_str(),
                                    nullptr, nullptr),
                   "t");
    writer = Entity(dds_create_writer(participant.handle(), topic.handle(),
                                      WriterQos(BuiltInTable().At("/forces")).get(), nullptr),
                    "w");
  }
  Entity participant;
  Entity topic;
  Entity writer;
};

std::optional<WriterConflict> ConflictWith(const ProcessIdentity& process,
                                           SteadyClock::duration own_age,
                                           SteadyClock::duration wait = {}) {
  TestNode node("node");
  const auto writer = node.participant.CreateWriter(kForcesTopic);
  SoleWriters writers(node.participant, SteadyClock::now() - own_age);
  const OtherProcess other(process);
  std::optional<WriterConflict> conflict;
  node.loop.Every(std::chrono::milliseconds(20),
                  [&] { conflict = writers.Find(SteadyClock::now()); });
  if (!node.WaitFor([&] { return conflict.has_value(); })) return std::nullopt;
  return writers.Find(SteadyClock::now() + wait);
}

TEST(SoleWriters, ASecondOneOfAnotherHostIsNamed) {
  const auto conflict = ConflictWith(Elsewhere(), std::chrono::hours(1));
  ASSERT_TRUE(conflict);
  EXPECT_THAT(conflict->reason,
              HasSubstr("two processes write /forces: this one and palpate-force-estimation "
                        "(process 4711 on host lab2); stop one of them"));
  EXPECT_FALSE(conflict->came_later);
}

TEST(SoleWriters, TheLaterOneOfThisHostGoesAtOnce) {
  ProcessIdentity older = ThisProcess();
  older.process_id = 1;
  older.start_ns -= 1;
  const auto conflict = ConflictWith(older, std::chrono::seconds(1));
  ASSERT_TRUE(conflict);
  EXPECT_TRUE(conflict->came_later);
  ProcessIdentity younger = older;
  younger.start_ns = ThisProcess().start_ns + 1;
  EXPECT_FALSE(ConflictWith(younger, std::chrono::seconds(1))->came_later);
}

TEST(SoleWriters, OneOfAnotherHostMayBeAPredecessorThatDdsHasNotDroppedYet) {
  EXPECT_FALSE(ConflictWith(Elsewhere(), std::chrono::seconds(1))->came_later);
  EXPECT_TRUE(
      ConflictWith(Elsewhere(), std::chrono::seconds(1), std::chrono::seconds(23))->came_later);
  // Nor can a process of another container be looked after.
  ProcessIdentity container = ThisProcess();
  container.process_namespace = "pid:[1]";
  container.start_ns -= 1;
  EXPECT_FALSE(ConflictWith(container, std::chrono::seconds(1))->came_later);
}

TEST(SoleWriters, OtherNamespacesAndEndedProcessesAreNoConflict) {
  TestNode node("node");
  const auto writer = node.participant.CreateWriter(kForcesTopic);
  SoleWriters writers(node.participant, SteadyClock::now());
  const OtherProcess elsewhere(Elsewhere(), "/left/forces");
  ProcessIdentity ended = ThisProcess();
  ended.process_id = 0x7FFFFFF;
  const OtherProcess killed(ended);
  Publications all(node.participant.handle(), [](const std::string&) { return false; });
  node.loop.Every(std::chrono::milliseconds(20), [&] { (void)all.Update(); });
  ASSERT_TRUE(node.WaitFor([&] {
    int found = 0;
    for (const auto& [guid, publication] : all.all()) {
      found += publication.dds_type.find("ForceArray") != std::string::npos ? 1 : 0;
    }
    return found == 2;
  }));
  EXPECT_FALSE(writers.Find(SteadyClock::now()));
}

TEST(HealthReporter, SaysThatAnotherProcessWritesTheSame) {
  TestNode node("node");
  TestNode listener("listener");
  std::string line;
  NodeLog log(node.participant, [&](Severity, std::string_view text) { line = text; });
  const auto writer = node.participant.CreateWriter(kForcesTopic);
  HealthReporter health(node.participant, "force_estimation",
                        SteadyClock::now() - std::chrono::hours(1));
  auto statuses = listener.participant.CreateReader(kComponentStatusTopic);
  std::string reason;
  const auto report = [&] { health.Report(Status::Ok(), {}, {}, SteadyClock::now()); };
  listener.loop.Every(std::chrono::milliseconds(50), report);
  listener.loop.Attach(statuses, [&] {
    for (const auto& status : statuses.Take()) reason = Text(status.reason);
  });
  {
    const OtherProcess other(Elsewhere());
    EXPECT_TRUE(listener.WaitFor([&] { return reason.find("two processes") != reason.npos; }));
    EXPECT_THAT(line, HasSubstr("two processes write /forces"));
  }
  EXPECT_TRUE(listener.WaitFor([&] { return reason.empty(); }));
  EXPECT_THAT(line, HasSubstr("only writer"));
}

TEST(HealthReporter, EndsAProcessThatCameLater) {
  TestNode node("node");
  const auto writer = node.participant.CreateWriter(kForcesTopic);
  HealthReporter health(node.participant, "force_estimation", SteadyClock::now());
  ProcessIdentity older = ThisProcess();
  older.process_id = 1;
  older.start_ns -= 1;
  const OtherProcess other(older);
  std::string refusal;
  node.loop.Every(std::chrono::milliseconds(20), [&] {
    try {
      health.Report(Status::Ok(), {}, {}, SteadyClock::now());
    } catch (const RunError& error) {
      refusal = error.what();
    }
  });
  ASSERT_TRUE(node.WaitFor([&] { return !refusal.empty(); }));
  EXPECT_THAT(refusal, HasSubstr("--remap __ns:=/NAME"));
}

/// A participant on a host of the given name.
struct OnHost {
  OnHost(const char* host, bool remote_raw) {
    setenv("PALPATE_HOST", host, 1);
    participant = std::make_unique<Participant>(
        ParticipantSettings{.domain_id = TestDomain(), .node_name = "n", .remote_raw = remote_raw},
        BuiltInTable());
  }
  ~OnHost() { unsetenv("PALPATE_HOST"); }
  std::unique_ptr<Participant> participant;
};

TEST(RemoteRaw, ImagesThatStayOnTheirHostHaveNoReaderElsewhere) {
  TestNode loop("loop");
  OnHost camera("a", false);
  auto images = camera.participant->CreateWriter(kDepthImageTopic);
  auto clouds = camera.participant->CreateWriter(kRobotCloudTopic);
  auto near_images = camera.participant->CreateReader(kDepthImageTopic);
  OnHost model("b", false);
  auto far_images = model.participant->CreateReader(kDepthImageTopic);
  auto far_clouds = model.participant->CreateReader(kRobotCloudTopic);
  OnHost ros("c", true);
  auto ros_images = ros.participant->CreateReader(kDepthImageTopic);
  auto driver = ros.participant->CreateWriter(kDepthImageTopic);
  loop.loop.Every(std::chrono::milliseconds(20), [] {});
  // What a driver of ROS 2 sends has readers everywhere.
  ASSERT_TRUE(
      loop.WaitFor([&] { return far_clouds.matched() == 1 && near_images.matched() == 2; }));
  ASSERT_TRUE(loop.WaitFor([&] { return far_images.matched() == 1 && ros_images.matched() == 1; }));
  EXPECT_EQ(images.matched(), 1U);
  EXPECT_EQ(driver.matched(), 3U);
}

}  // namespace
}  // namespace palpate::dds
