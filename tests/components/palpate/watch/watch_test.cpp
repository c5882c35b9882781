// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/watch/watch_verb.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "components/palpate/node/live/live_messages.hpp"
#include "components/palpate/node/verbs.hpp"
#include "components/palpate/node/watch/system_listener.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/wait_set.hpp"
#include "tests/components/palpate/watch/test_domain.hpp"

namespace palpate::command {
namespace {

using testing::HasSubstr;

/// Stands in for palpate-force-estimation: reports and sends a force until it goes.
class FakeEstimator {
 public:
  explicit FakeEstimator(const std::vector<std::string>& remap = {})
      : participant_(JoinDomain("palpate_force_estimation", TestDomain(), remap)) {
    loop_.Every(std::chrono::milliseconds(20), [this] { SendForce(); });
    loop_.Every(std::chrono::milliseconds(200), [this] {
      health_.Report(Status::Ok(), {.received = sent_, .latencies_s = {}}, {{"waiting_for", ""}},
                     dds::HealthReporter::Clock::now());
    });
    thread_ = std::thread([this] { loop_.Run(); });
  }
  ~FakeEstimator() {
    loop_.Stop();
    thread_.join();
  }

 private:
  void SendForce() {
    dds::Message<idl::palpate_msgs::ForceArray> message;
    message->counter = sent_++;
    dds::SetText(message->status, "ok");
    dds::Resize(message->forces, 1);
    dds::SetText(message->forces._buffer[0].name, "ball");
    dds::SetText(message->forces._buffer[0].status, "ok");
    message->forces._buffer[0].force_n = {0.0, 0.3, 0.4};
    EXPECT_TRUE(forces_.Write(message));
  }

  dds::Participant participant_;
  dds::WaitSet loop_{participant_};
  dds::HealthReporter health_{participant_, "force_estimation", dds::HealthReporter::Clock::now()};
  dds::Writer<idl::palpate_msgs::ForceArray> forces_ = participant_.CreateWriter(dds::kForcesTopic);
  std::uint64_t sent_ = 0;
  std::thread thread_;
};

TEST(Watch, TheListenerShowsAProcessAndItsForce) {
  const FakeEstimator estimator;
  SystemListener listener(TestDomain());
  listener.Listen([&] { return listener.HeardAll() && listener.Snapshot().forces; },
                  std::chrono::seconds(10));
  const monitor::SystemSnapshot snapshot = listener.Snapshot();
  ASSERT_EQ(snapshot.processes.size(), 1u);
  EXPECT_EQ(snapshot.processes[0].name, "force_estimation");
  ASSERT_TRUE(snapshot.forces);
  ASSERT_EQ(snapshot.forces->forces.size(), 1u);
  EXPECT_NEAR(snapshot.forces->forces[0].force_N.norm(), 0.5, 1e-12);
}

TEST(Watch, SeesOneRobotOfTwoByItsNamespace) {
  const std::vector<std::string> left{"__ns:=/left"};
  const FakeEstimator estimator(left);
  SystemListener listener(TestDomain(), left);
  const SystemListener other(TestDomain(), {"__ns:=/right"});
  listener.Listen([&] { return listener.HeardAll() && listener.Snapshot().forces; },
                  std::chrono::seconds(10));
  EXPECT_EQ(listener.Snapshot().processes.size(), 1u);
  EXPECT_TRUE(listener.Snapshot().forces);
  EXPECT_TRUE(other.Snapshot().processes.empty());
}

TEST(Watch, OncePrintsOneObjectAndExitsWith0) {
  const FakeEstimator estimator;
  testing::internal::CaptureStdout();
  const int code = RunCommand({"watch", "--once", "--json", "--timeout", "10"});
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_EQ(code, 0);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("domain"), TestDomain());
  EXPECT_EQ(json.at("processes").at(0).at("status"), "ok");
  EXPECT_NEAR(json.at("forces").at("contacts").at(0).at("size_N"), 0.5, 1e-12);
  EXPECT_GT(json.at("forces").at("rate_hz"), 0.0);
}

TEST(Watch, OnceWithoutAProcessSaysSoAndExitsWith1) {
  testing::internal::CaptureStdout();
  const int code = RunCommand({"watch", "--once", "--timeout", "0.3"});
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("no palpate process in domain " + std::to_string(TestDomain())));
  EXPECT_EQ(code, 1);
}

std::string RefusalOf(const std::vector<std::string>& words) {
  try {
    RunCommand(words);
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Watch, RefusesRatesAndTimesThatAreNone) {
  EXPECT_THAT(RefusalOf({"watch", "--rate", "0"}), HasSubstr("--rate must be 0.1 to 20 Hz, not 0"));
  EXPECT_THAT(RefusalOf({"watch", "--rate", "1000"}), HasSubstr("--rate must be"));
  EXPECT_THAT(RefusalOf({"watch", "--once", "--timeout", "-1"}),
              HasSubstr("--timeout must be above 0 s, not -1"));
  EXPECT_THAT(RefusalOf({"watch", "--domain", "300"}), HasSubstr("--domain"));
}

}  // namespace
}  // namespace palpate::command
