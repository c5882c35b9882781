// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "components/palpate/node/live/live_messages.hpp"
#include "components/palpate/node/verbs.hpp"
#include "components/palpate/node/watch/health_verb.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/wait_set.hpp"
#include "tests/components/palpate/watch/test_domain.hpp"

namespace palpate::command {
namespace {

using testing::HasSubstr;

/// A component that does nothing but report.
class Reporter {
 public:
  Reporter(const std::string& component, const Status& status)
      : participant_(JoinDomain("palpate_" + component, TestDomain(), {})),
        health_(participant_, component, dds::HealthReporter::Clock::now()) {
    loop_.Every(std::chrono::milliseconds(100), [this, status] {
      health_.Report(status, {.latencies_s = {}}, {}, dds::HealthReporter::Clock::now());
    });
    thread_ = std::thread([this] { loop_.Run(); });
  }
  ~Reporter() {
    loop_.Stop();
    thread_.join();
  }

 private:
  dds::Participant participant_;
  dds::WaitSet loop_{participant_};
  dds::HealthReporter health_;
  std::thread thread_;
};

struct Answer {
  int code = -1;
  std::string text;
};

Answer Ask(std::vector<std::string> words) {
  words.insert(words.begin(), "health");
  testing::internal::CaptureStdout();
  const int code = RunCommand(words);
  return {code, testing::internal::GetCapturedStdout()};
}

monitor::SystemSnapshot SnapshotOf(const std::string& status, double silence_s) {
  monitor::SystemSnapshot snapshot;
  monitor::ProcessState& process = snapshot.processes.emplace_back();
  process.name = "capture";
  process.status = status;
  process.silence_s = silence_s;
  return snapshot;
}

TEST(Health, WhoReportsOkIsWell) {
  const auto health = HealthOf(SnapshotOf("ok", 1.0), {"capture"}, false);
  ASSERT_EQ(health.size(), 1u);
  EXPECT_TRUE(health[0].well);
}

TEST(Health, WhoHasAnotherStatusIsNotWellUnlessAskedFor) {
  EXPECT_FALSE(HealthOf(SnapshotOf("no_camera", 1.0), {"capture"}, false)[0].well);
  EXPECT_TRUE(HealthOf(SnapshotOf("no_camera", 1.0), {"capture"}, true)[0].well);
}

TEST(Health, WhoIsSilentIsNeverWell) {
  EXPECT_FALSE(HealthOf(SnapshotOf("ok", 10.0), {"capture"}, true)[0].well);
  EXPECT_EQ(HealthOf(SnapshotOf("ok", 10.0), {"capture"}, true)[0].state, "silent");
  EXPECT_EQ(HealthOf(SnapshotOf("ok", 1.0), {"perception"}, true)[0].state, "no report");
}

TEST(Health, TheExitCodeIs0WhereAllAreWell) {
  const Reporter capture("capture", Status::Ok());
  const Reporter estimator("force_estimation", Status::Ok());
  const Answer named = Ask({"force-estimation", "capture", "--timeout", "10"});
  EXPECT_EQ(named.code, 0);
  EXPECT_EQ(named.text, "force_estimation: ok\ncapture: ok\n");
  EXPECT_EQ(Ask({"--timeout", "10"}).code, 0);
}

TEST(Health, TheExitCodeIs1WhereOneIsNotWellOrAbsent) {
  const Reporter capture("capture", Status(StatusCode::kStale, "no camera answers"));
  const Answer ill = Ask({"capture", "perception", "--timeout", "1"});
  EXPECT_EQ(ill.code, 1);
  EXPECT_THAT(ill.text, HasSubstr("capture: "));
  EXPECT_THAT(ill.text, HasSubstr(", no camera answers\nperception: no report\n"));
  const Answer alive = Ask({"capture", "--any-status", "--json", "--timeout", "10"});
  EXPECT_EQ(alive.code, 0);
  const auto json = nlohmann::json::parse(alive.text);
  EXPECT_EQ(json.at("well"), true);
  EXPECT_EQ(json.at("components").at(0).at("reason"), "no camera answers");
}

TEST(Health, WithoutAProcessItSaysSo) {
  const Answer none = Ask({"--timeout", "0.3"});
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.text, HasSubstr("no palpate process in domain"));
}

TEST(Health, RefusesATimeThatIsNone) {
  EXPECT_THROW(RunCommand({"health", "--timeout", "0"}), InputError);
}

}  // namespace
}  // namespace palpate::command
