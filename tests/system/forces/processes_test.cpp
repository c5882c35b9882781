// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/system/process.hpp"
#include "tests/system/sample_data.hpp"

/// palpate-player and palpate-force-estimation as processes of their own.
namespace palpate::system_test::processes {
namespace {

using idl::palpate_msgs::ForceArray;
using std::chrono::seconds;
using ::testing::HasSubstr;

/// One frame's outcome: its status, and position, force and interval of each contact.
struct Outcome {
  std::string status;
  std::vector<double> numbers;
};
/// By recording and ms of the stamp.
using Outcomes = std::map<std::pair<std::string, int64_t>, Outcome>;

/// Listens to /forces.
class Listener {
 public:
  Listener()
      : node_("listener"),
        forces_(node_.participant.CreateReader(dds::kForcesTopic, node_.Waker())) {
    node_.loop.Attach(forces_, [this] { Take(); });
  }

  const Outcomes& outcomes() const { return outcomes_; }
  void Forget() { outcomes_.clear(); }

  /// What an estimator says before it and this listener know of each other is lost.
  bool WaitForEstimator() {
    return WaitFor([this] { return forces_.matched() > 0; });
  }

  /// Waits, at most 90 s, until `condition` holds.
  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return node_.loop.DispatchUntil(condition, dds::WaitSet::Clock::now() + seconds(90));
  }

 private:
  void Take() {
    for (const ForceArray& message : forces_.Take()) {
      Outcome outcome{std::string(dds::Text(message.status)), {}};
      for (const auto& force : dds::Elements(message.forces)) {
        const double numbers[] = {force.position_m.x, force.position_m.y, force.position_m.z,
                                  force.force_n.x,    force.force_n.y,    force.force_n.z,
                                  force.ci95_n};
        outcome.numbers.insert(outcome.numbers.end(), std::begin(numbers), std::end(numbers));
      }
      const int64_t stamp_ms = dds::StampNs(message.header.stamp) / 1'000'000;
      outcomes_[{std::string(dds::Text(message.recording)), stamp_ms}] = std::move(outcome);
    }
  }

  dds::TestNode node_;
  dds::Reader<ForceArray> forces_;
  Outcomes outcomes_;
};

/// forces.csv of `palpate estimate`, in the same form.
Outcomes ReadForcesCsv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  Outcomes outcomes;
  while (std::getline(stream, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    EXPECT_EQ(std::ranges::count(line, ','), 23) << line;
    Outcome& outcome = outcomes[{fields[0], std::llround(std::stod(fields[1]) * 1e3)}];
    const bool has_contact = !fields[2].empty();
    outcome.status = has_contact ? "ok" : fields[11];
    for (size_t i = 3; has_contact && i < 10; ++i) outcome.numbers.push_back(std::stod(fields[i]));
  }
  return outcomes;
}

std::vector<std::string> EstimatorArguments(const Sample& sample) {
  return {sample.robot.string(), "--contact", sample.contact};
}

Outcomes EstimateAtTheDesk(const Sample& sample, const TestFolder& folder) {
  const auto csv = folder / "forces.csv";
  std::vector<std::string> arguments{"estimate", sample.robot.string(), "--contact", sample.contact,
                                     "--data",   sample.data.string(),  "--out",     csv.string()};
  EXPECT_EQ(RunProgram("palpate", arguments, folder / "estimate.log"), sample.estimate_exits);
  return ReadForcesCsv(csv);
}

void ExpectSameForces(const Outcomes& desk, const Outcomes& processes) {
  EXPECT_EQ(desk.size(), processes.size());
  for (const auto& [frame, expected] : desk) {
    SCOPED_TRACE(frame.first + " at " + std::to_string(frame.second) + " ms");
    const auto found = processes.find(frame);
    ASSERT_NE(found, processes.end());
    EXPECT_EQ(found->second.status, expected.status);
    ASSERT_EQ(found->second.numbers.size(), expected.numbers.size());
    for (size_t i = 0; i < expected.numbers.size(); ++i) {
      EXPECT_NEAR(found->second.numbers[i], expected.numbers[i], 1e-9);
    }
  }
}

size_t CountWithForces(const Outcomes& outcomes) {
  size_t count = 0;
  for (const auto& [frame, outcome] : outcomes) count += outcome.numbers.empty() ? 0 : 1;
  return count;
}

void ExpectProcessesToEqualTheDesk(const Sample& sample, const TestFolder& folder) {
  const Outcomes desk = EstimateAtTheDesk(sample, folder);
  EXPECT_GE(CountWithForces(desk), 3u);
  Listener listener;
  Process estimator("palpate-force-estimation", EstimatorArguments(sample), folder / "fe.log");
  ASSERT_TRUE(listener.WaitForEstimator());
  Process player("palpate-player", {"--data", sample.data.string(), "--step"},
                 folder / "player.log");
  EXPECT_TRUE(listener.WaitFor([&] { return listener.outcomes().size() == desk.size(); }));
  EXPECT_EQ(player.Wait(seconds(30)), 0) << player.Output();
  ExpectSameForces(desk, listener.outcomes());
  estimator.Signal(SIGTERM);
  EXPECT_EQ(estimator.Wait(seconds(20)), 0) << estimator.Output();
}

TEST(Processes, GiveTheForcesOfTheDeskOnTheBeam) {
  const TestFolder folder;
  ExpectProcessesToEqualTheDesk(WriteBeamSample(folder, 10), folder);
}

TEST(Processes, GiveTheForcesOfTheDeskOnTheRobotWithCables) {
  const TestFolder folder;
  ExpectProcessesToEqualTheDesk(WriteFourLegSample(folder), folder);
}

TEST(Processes, RecoverWhenTheEstimatorIsKilledAndStartedAgain) {
  const TestFolder folder;
  const Sample sample = WriteBeamSample(folder, 10);
  const Outcomes desk = EstimateAtTheDesk(sample, folder);
  Listener listener;
  // Round and round: answers that come before the listener knows the second estimator are lost.
  Process player("palpate-player", {"--data", sample.data.string(), "--step", "--loop"},
                 folder / "player.log");
  {
    Process first("palpate-force-estimation", EstimatorArguments(sample), folder / "fe1.log");
    ASSERT_TRUE(listener.WaitFor([&] { return CountWithForces(listener.outcomes()) >= 1; }));
    first.Signal(SIGKILL);
    EXPECT_EQ(first.Wait(seconds(10)), -SIGKILL);
  }
  listener.Forget();
  Process second("palpate-force-estimation", EstimatorArguments(sample), folder / "fe2.log");
  EXPECT_TRUE(listener.WaitFor([&] { return listener.outcomes().size() == desk.size(); }));
  ExpectSameForces(desk, listener.outcomes());
  player.Signal(SIGTERM);
  EXPECT_EQ(player.Wait(seconds(30)), 0) << player.Output();
  EXPECT_THAT(player.Output(), HasSubstr("the recording begins again"));
}

TEST(Processes, RecoverWhenThePlayerIsKilledAndStartedAgain) {
  const TestFolder folder;
  const Sample sample = WriteBeamSample(folder, 10);
  const Outcomes desk = EstimateAtTheDesk(sample, folder);
  Listener listener;
  Process estimator("palpate-force-estimation", EstimatorArguments(sample), folder / "fe.log");
  ASSERT_TRUE(listener.WaitForEstimator());
  {
    Process first("palpate-player", {"--data", sample.data.string(), "--step"},
                  folder / "player1.log");
    ASSERT_TRUE(listener.WaitFor([&] { return CountWithForces(listener.outcomes()) >= 1; }));
    first.Signal(SIGKILL);
    EXPECT_EQ(first.Wait(seconds(10)), -SIGKILL);
  }
  Process second("palpate-player", {"--data", sample.data.string(), "--step"},
                 folder / "player2.log");
  EXPECT_TRUE(listener.WaitFor([&] { return listener.outcomes().size() == desk.size(); }));
  EXPECT_EQ(second.Wait(seconds(120)), 0) << second.Output();
  ExpectSameForces(desk, listener.outcomes());
}

TEST(Processes, SayWhatIsWrongAndExitWithTheAgreedCode) {
  const TestFolder folder;
  const auto log = folder / "log";
  EXPECT_EQ(RunProgram("palpate-player", {}, log), 2);
  EXPECT_EQ(RunProgram("palpate-player", {"--data", "/nowhere"}, log), 2);
  EXPECT_EQ(RunProgram("palpate-player", {"--data", ".", "--step", "--rate", "2"}, log), 2);
  EXPECT_EQ(RunProgram("palpate-force-estimation", {}, log), 2);
  EXPECT_EQ(RunProgram("palpate-force-estimation", {"/nowhere.yaml"}, log), 2);

  const Sample sample = WriteBeamSample(folder, 10);
  Process lonely("palpate-player",
                 {"--data", sample.data.string(), "--set", "reader_deadline_s=0.1"}, log);
  EXPECT_EQ(lonely.Wait(seconds(20)), 1);
  EXPECT_THAT(lonely.Output(), HasSubstr("no reader of /perception/markers"));
}

TEST(Processes, StopCleanlyOnSigterm) {
  const TestFolder folder;
  const Sample sample = WriteBeamSample(folder, 10);
  Listener listener;
  Process estimator("palpate-force-estimation", EstimatorArguments(sample), folder / "fe.log");
  Process player("palpate-player", {"--data", sample.data.string(), "--loop", "--rate", "5"},
                 folder / "player.log");
  ASSERT_TRUE(listener.WaitFor([&] { return CountWithForces(listener.outcomes()) >= 1; }));
  player.Signal(SIGTERM);
  estimator.Signal(SIGTERM);
  EXPECT_EQ(player.Wait(seconds(20)), 0) << player.Output();
  EXPECT_EQ(estimator.Wait(seconds(20)), 0) << estimator.Output();
}

}  // namespace
}  // namespace palpate::system_test::processes
