// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/live_listener.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "components/palpate/node/live/live_messages.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::command {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;

/// The domain that this test program has for itself (set by CMake).
int TestDomain() {
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  return domain ? std::atoi(domain) : 0;
}

/// Stands in for the processes of the system: sends what they say about one frame.
class FakeSystem {
 public:
  FakeSystem()
      : participant_(JoinDomain("fake_system", TestDomain())),
        truth_(participant_.CreateWriter(dds::kTrueForcesTopic)),
        pictures_(participant_.CreateWriter(dds::kFrameInfoTopic)),
        perceived_(participant_.CreateWriter(dds::kPerceptionReportTopic)),
        forces_(participant_.CreateWriter(dds::kForcesTopic)) {}

  void SendFrame(std::int64_t stamp_ns, const char* status) {
    dds::Message<idl::palpate_msgs::FrameInfo> picture;
    dds::SetHeader(picture->header, stamp_ns, "camera");
    picture->stamp_receive_ns = stamp_ns + 14 * kMs_ns;
    dds::Message<idl::palpate_msgs::PerceptionReport> report;
    dds::SetHeader(report->header, stamp_ns, "camera");
    report->age_s = 0.100;
    report->latency_s = 0.020;
    auto forces = Forces(stamp_ns, status);
    forces->age_s = 0.130;
    forces->latency_s = 0.010;
    EXPECT_TRUE(truth_.Write(Forces(stamp_ns, "ok")) && pictures_.Write(picture) &&
                perceived_.Write(report) && forces_.Write(forces));
  }

 private:
  static dds::Message<idl::palpate_msgs::ForceArray> Forces(std::int64_t stamp_ns,
                                                            const char* status) {
    dds::Message<idl::palpate_msgs::ForceArray> message;
    dds::SetHeader(message->header, stamp_ns, "robot");
    dds::SetText(message->status, status);
    return message;
  }

  dds::Participant participant_;
  dds::Writer<idl::palpate_msgs::ForceArray> truth_;
  dds::Writer<idl::palpate_msgs::FrameInfo> pictures_;
  dds::Writer<idl::palpate_msgs::PerceptionReport> perceived_;
  dds::Writer<idl::palpate_msgs::ForceArray> forces_;
};

/// Sends frames, one each 50 ms, until the listener has `done`; false after 10 s.
template <typename Done>
bool SendUntil(FakeSystem& system, LiveListener& listener, const char* status, const Done& done) {
  for (int i = 0; i < 200; ++i) {
    system.SendFrame(dds::WallClockNs() - 60 * kMs_ns, status);
    if (listener.Listen(done, std::chrono::milliseconds(50))) return true;
  }
  return false;
}

TEST(LiveListener, TellsFromTheMessagesWhereTheTimeOfAFrameGoes) {
  FakeSystem system;
  LiveListener listener(TestDomain(), LiveListener::Truth::kKnown);
  const StageTimes& stages = listener.stages();
  ASSERT_TRUE(
      SendUntil(system, listener, "no_contact", [&] { return listener.stages().frames() >= 3; }));
  EXPECT_NEAR(stages.Median_s(Milestone::kReceived), 0.014, 1e-9);
  // From the last packet, 14 ms after the exposure, to when it was sent, 60 ms or more after it.
  EXPECT_GE(stages.Median_s(Milestone::kPublished), 0.046 - 1e-6);
  EXPECT_NEAR(stages.Median_s(Milestone::kPerceived), 0.020, 1e-9);
  EXPECT_NEAR(stages.Median_s(Milestone::kEstimating), 0.020, 1e-9);
  EXPECT_NEAR(stages.Median_s(Milestone::kEstimated), 0.010, 1e-9);
  EXPECT_NE(stages.ToText(), "");
}

TEST(LiveListener, FramesThatNobodyEstimatedHaveNoStages) {
  FakeSystem system;
  LiveListener listener(TestDomain(), LiveListener::Truth::kKnown);
  ASSERT_TRUE(SendUntil(system, listener, "no_calibration",
                        [&] { return listener.comparison().frames() >= 3; }));
  EXPECT_EQ(listener.stages().frames(), 0u);
}

}  // namespace
}  // namespace palpate::command
