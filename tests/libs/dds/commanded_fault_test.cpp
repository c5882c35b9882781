// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/commanded_fault.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "libs/dds/health.hpp"
#include "libs/dds/parameter_client.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

using idl::palpate_msgs::ForceArray;
using std::chrono::steady_clock;
using testing::HasSubstr;

/// A force of `counter` newtons.
Message<ForceArray> Force(std::uint64_t counter) {
  Message<ForceArray> forces;
  SetHeader(forces->header, static_cast<std::int64_t>(counter), "robot");
  forces->counter = counter;
  Resize(forces->forces, 1);
  SetText(forces->forces._buffer[0].name, "tip");
  forces->forces._buffer[0].force_n = {0.0, 0.0, static_cast<double>(counter)};
  return forces;
}

struct Heard {
  std::uint64_t counter = 0;
  std::int64_t stamp_ns = 0;
  double force_N = 0.0;
  steady_clock::time_point when;
};

class CommandedFaultTest : public testing::Test {
 protected:
  CommandedFaultTest()
      : sender_({.domain_id = TestDomain(), .node_name = "sender", .allow_faults = true},
                BuiltInTable()),
        loop_(sender_),
        forces_(sender_.CreateWriter(kForcesTopic, [this] { receiver_.loop.Wake(); })),
        reader_(receiver_.participant.CreateReader(kForcesTopic)) {
    sender_.SetLog([this](Severity, std::string_view text) { log_.emplace_back(text); });
    receiver_.loop.Attach(reader_, [this] { Take(); });
    EXPECT_TRUE(receiver_.WaitFor([&] { return forces_.matched() == 1; }));
  }

  /// As a node of ROS 2 would, but without the way over the network.
  std::string Set(const std::string& kind) {
    for (const Parameter& parameter : FaultParameters(sender_.fault())) {
      if (parameter.name == kFaultParameter) return parameter.change(kind);
    }
    return "no parameter";
  }
  void SetDelay(double delay_s) { EXPECT_EQ(sender_.fault()->SetDelay(delay_s), ""); }

  bool HearsNext() {
    return receiver_.WaitFor([&, before = heard_.size()] { return heard_.size() > before; });
  }
  Heard SendAndHear(std::uint64_t counter) {
    EXPECT_TRUE(forces_.Write(Force(counter)));
    EXPECT_TRUE(HearsNext());
    return heard_.empty() ? Heard{} : heard_.back();
  }

  TestNode receiver_{"receiver"};
  Participant sender_;
  WaitSet loop_;
  Writer<ForceArray> forces_;
  Reader<ForceArray> reader_;
  std::vector<Heard> heard_;
  std::vector<std::string> log_;

 private:
  void Take() {
    for (const ForceArray& message : reader_.Take()) {
      heard_.push_back({message.counter, StampNs(message.header.stamp),
                        message.forces._buffer[0].force_n.z, steady_clock::now()});
    }
  }
};

TEST_F(CommandedFaultTest, OffSendsNothingUntilItEnds) {
  ASSERT_EQ(Set("off"), "");
  EXPECT_TRUE(forces_.Write(Force(1)));
  EXPECT_TRUE(forces_.Write(Force(2)));
  ASSERT_EQ(Set("none"), "");
  EXPECT_EQ(SendAndHear(3).counter, 3u);
  EXPECT_EQ(heard_.size(), 1u);
  EXPECT_THAT(log_, testing::ElementsAre("fault on command: off", "fault on command ends: off"));
}

TEST_F(CommandedFaultTest, StuckRepeatsTheDataUnderNewStampsAndCounters) {
  EXPECT_EQ(SendAndHear(1).force_N, 1.0);
  ASSERT_EQ(Set("stuck"), "");
  EXPECT_EQ(SendAndHear(2).force_N, 2.0);
  const Heard third = SendAndHear(3);
  EXPECT_EQ(third.force_N, 2.0);
  EXPECT_EQ(third.counter, 3u);
  EXPECT_EQ(third.stamp_ns, 3);
  // Begun again, it holds what comes then.
  ASSERT_EQ(Set("stuck"), "");
  EXPECT_EQ(SendAndHear(4).force_N, 4.0);
}

TEST_F(CommandedFaultTest, SlowDelaysEachMessageAndKeepsTheOrder) {
  SetDelay(0.2);
  ASSERT_EQ(Set("slow"), "");
  const auto sent = steady_clock::now();
  for (std::uint64_t counter = 1; counter <= 3; ++counter) {
    EXPECT_TRUE(forces_.Write(Force(counter)));
  }
  EXPECT_LT(steady_clock::now() - sent, std::chrono::milliseconds(150)) << "the loop was blocked";
  ASSERT_TRUE(receiver_.WaitFor([&] { return heard_.size() == 3; }));
  EXPECT_GE(heard_.front().when - sent, std::chrono::milliseconds(200));
  for (std::uint64_t i = 0; i < 3; ++i) EXPECT_EQ(heard_[i].counter, i + 1);
}

TEST_F(CommandedFaultTest, WhatSlowHoldsBackIsSentWhenItEnds) {
  SetDelay(10.0);
  ASSERT_EQ(Set("slow"), "");
  EXPECT_TRUE(forces_.Write(Force(1)));
  EXPECT_TRUE(forces_.Write(Force(2)));
  ASSERT_EQ(Set("none"), "");
  EXPECT_TRUE(forces_.Write(Force(3)));
  ASSERT_TRUE(receiver_.WaitFor([&] { return heard_.size() == 3; }));
  for (std::uint64_t i = 0; i < 3; ++i) EXPECT_EQ(heard_[i].counter, i + 1);
}

TEST_F(CommandedFaultTest, GarbageIsRandomAndSometimesNotFinite) {
  ASSERT_EQ(Set("garbage"), "");
  bool finite = false;
  bool not_finite = false;
  for (std::uint64_t counter = 0; counter < 200; ++counter) {
    const Heard heard = SendAndHear(counter);
    EXPECT_EQ(heard.counter, counter);
    (std::isfinite(heard.force_N) ? finite : not_finite) = true;
  }
  EXPECT_TRUE(finite && not_finite);
}

TEST_F(CommandedFaultTest, WrongChangesTheDataAlone) {
  ASSERT_EQ(Set("wrong"), "");
  const Heard heard = SendAndHear(4);
  EXPECT_EQ(heard.force_N, 6.0);
  EXPECT_EQ(heard.counter, 4u);
}

TEST_F(CommandedFaultTest, HowTheProcessFaresIsSaidUnderEveryFault) {
  auto reader = receiver_.participant.CreateReader(kDiagnosticsTopic);
  HealthReporter health(sender_, "sender", steady_clock::now());
  std::string fault;
  receiver_.loop.Attach(reader, [&] {
    for (const auto& message : reader.Take()) {
      for (const auto& value : Elements(message.status._buffer[0].values)) {
        if (Text(value.key) == "fault_on_command") fault = Text(value.value);
      }
    }
  });
  ASSERT_TRUE(receiver_.WaitFor([&] { return reader.matched() == 1; }));
  for (const std::string& kind : FaultWords()) {
    ASSERT_EQ(Set(kind), "");
    EXPECT_TRUE(receiver_.WaitFor([&] {
      health.Report(Status::Ok(), {}, {}, steady_clock::now());
      return fault == kind;
    })) << kind;
  }
}

TEST_F(CommandedFaultTest, RefusesWhatIsNoFault) {
  EXPECT_THAT(Set("stcuk"), HasSubstr("did you mean 'stuck'"));
  CommandedFault* fault = sender_.fault();
  EXPECT_THAT(fault->Set(1.0), HasSubstr("must be one of none, off"));
  for (const ParameterValue& value :
       {ParameterValue(0.0), ParameterValue(std::nan("")), ParameterValue(std::string("1"))}) {
    EXPECT_THAT(fault->SetDelay(value), HasSubstr("must be a number of"));
  }
}

TEST(CommandedFault, SlowHoldsNoMoreThanItMay) {
  CommandedFault fault([](const std::string&) {});
  fault.AddWriter(false);
  ASSERT_EQ(fault.SetDelay(10.0), "");
  ASSERT_EQ(fault.Set(std::string("slow")), "");
  int sent = 0;
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  EXPECT_TRUE(fault.SendLater(200 * kMiB, [&] { ++sent; }));
  EXPECT_FALSE(fault.SendLater(100 * kMiB, [&] { ++sent; }));
  EXPECT_TRUE(fault.SendLater(50 * kMiB, [&] { ++sent; }));
  EXPECT_EQ(sent, 0);
  ASSERT_EQ(fault.Set(std::string("none")), "");
  EXPECT_EQ(sent, 2);
}

TEST(CommandedFault, RefusesAProcessThatWritesNoData) {
  CommandedFault fault([](const std::string&) {});
  EXPECT_THAT(fault.Set(std::string("off")), HasSubstr("writes no data"));
  fault.AddWriter(false);
  EXPECT_EQ(fault.Set(std::string("off")), "");
  EXPECT_THAT(fault.Set(std::string("wrong")), HasSubstr("no wrong form"));
}

TEST(CommandedFault, ANodeThatDoesNotAllowItSaysWhichKeyDoes) {
  Parameter other{"other", 1.0};
  other.fixed_because = "read at start";
  Participant participant({.domain_id = TestDomain(), .node_name = "strict", .parameters = {other}},
                          BuiltInTable());
  WaitSet loop(participant);
  std::thread thread([&] { loop.Run(); });
  const TestNode asking("asking");
  const ParameterClient client(asking.participant.handle(), "/strict", std::chrono::seconds(10));
  const std::string refusal = client.Set(kFaultParameter, std::string("off"));
  loop.Stop();
  thread.join();
  EXPECT_THAT(refusal,
              testing::AllOf(HasSubstr("dds.allow_faults"), HasSubstr("allow_faults: true")));
  EXPECT_EQ(participant.fault(), nullptr);
}

}  // namespace
}  // namespace palpate::dds
