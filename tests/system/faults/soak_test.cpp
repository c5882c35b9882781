// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "libs/core/seconds.hpp"
#include "libs/core/statistics.hpp"
#include "tests/system/faults/launched_system.hpp"
#include "tests/system/faults/system_listener.hpp"

/// The whole system under `palpate launch`, whose processes are killed one after the other.
namespace palpate::system_test::soak {
namespace {

using Clock = SystemListener::Clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kBackoff_s = 0.5;
/// From the restart of a process to the first estimate: it loads its model, finds its partners, the
/// camera is opened again (3 s after it was lost), and the depth bias is learned from 8 frames.
constexpr double kStart_s = 20.0;
/// A process that has just started has not yet all that it needs.
constexpr double kWarmUp_s = 5.0;
constexpr double kMostGrowth = 1.05;
/// In a shorter soak a process sees its partners restart once or never, and memory has no level.
constexpr double kSteady_s = 600.0;

/// What a process held at one time.
struct Sample {
  double t_s = 0.0;  ///< since the beginning of the soak
  Holdings holds;
};

class Soak : public testing::Test {
 protected:
  void Run(seconds duration);

 private:
  void ListenAndSample(milliseconds duration);
  void TakeSamples();
  void KillAndAwait(const std::string& component);
  void ExpectLevel(const std::string& name, const std::vector<Sample>& samples) const;

  struct Life {
    pid_t pid = 0;
    Clock::time_point since;
  };

  TestFolder folder_;
  SystemListener listener_;
  Clock::time_point begin_;
  double duration_s_ = 0.0;
  std::map<std::string, Life> lives_;
  std::map<std::string, std::vector<Sample>> samples_;
  std::vector<double> returns_s_;
  std::unique_ptr<LaunchedSystem> system_;
};

void Soak::TakeSamples() {
  auto pids = system_->Pids();
  pids["launch"] = system_->launch().pid();
  for (const auto& [name, pid] : pids) {
    Life& life = lives_[name];
    if (life.pid != pid) life = {pid, Clock::now()};
    if (SecondsSince(life.since) < kWarmUp_s) continue;
    const auto holds = HoldingsOf(pid);
    if (holds) samples_[name].push_back({SecondsSince(begin_), *holds});
  }
}

void Soak::ListenAndSample(milliseconds duration) {
  const auto end = Clock::now() + duration;
  while (Clock::now() < end) {
    listener_.ListenFor(milliseconds(250));
    TakeSamples();
  }
}

void Soak::KillAndAwait(const std::string& component) {
  const auto pids = system_->Pids();
  const auto found = pids.find(component);
  ASSERT_NE(found, pids.end()) << component << " does not run\n" << system_->launch().Output();
  kill(found->second, SIGKILL);
  const auto killed = Clock::now();
  listener_.ListenFor(milliseconds(200));  // what was on its way
  listener_.Forget();
  const auto end = killed + FromSeconds(kBackoff_s + kStart_s);
  const auto comes_again = [&] { return listener_.estimates_in_a_row() >= 3; };
  while (!comes_again() && Clock::now() < end) {
    listener_.WaitFor(comes_again, seconds(1));
    TakeSamples();
  }
  ASSERT_TRUE(comes_again()) << "no estimate " << SecondsSince(killed) << " s after " << component
                             << " was killed: " << listener_.last() << "\n"
                             << system_->launch().Output();
  returns_s_.push_back(SecondsSince(killed));
  std::printf("%6.1f s: %s killed, estimates again after %.1f s\n", ToSeconds(killed - begin_),
              component.c_str(), returns_s_.back());
}

void Soak::ExpectLevel(const std::string& name, const std::vector<Sample>& samples) const {
  const auto in_quarter = [&](int quarter) {
    std::vector<Sample> chosen;
    std::copy_if(samples.begin(), samples.end(), std::back_inserter(chosen), [&](const Sample& s) {
      return s.t_s >= 0.25 * duration_s_ * (quarter - 1) && s.t_s < 0.25 * duration_s_ * quarter;
    });
    return chosen;
  };
  const auto median = [](const std::vector<Sample>& chosen, const auto& value) {
    std::vector<double> values;
    for (const Sample& sample : chosen) values.push_back(static_cast<double>(value(sample.holds)));
    std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
    return values[values.size() / 2];
  };
  const auto second = in_quarter(2);
  const auto last = in_quarter(4);
  if (second.empty() || last.empty()) {
    std::printf("%-16s ran too shortly between the kills to be compared\n", name.c_str());
    return;
  }
  const auto memory = [](const Holdings& holds) { return holds.memory_MiB; };
  const auto files = [](const Holdings& holds) { return holds.files; };
  const auto threads = [](const Holdings& holds) { return holds.threads; };
  std::printf("%-16s %7.1f -> %7.1f MiB, %3.0f -> %3.0f files, %3.0f -> %3.0f threads\n",
              name.c_str(), median(second, memory), median(last, memory), median(second, files),
              median(last, files), median(second, threads), median(last, threads));
  if (duration_s_ >= kSteady_s) {
    EXPECT_LE(median(last, memory), kMostGrowth * median(second, memory)) << name;
  }
  EXPECT_LE(median(last, files), median(second, files)) << name;
  EXPECT_LE(median(last, threads), median(second, threads)) << name;
}

void Soak::Run(seconds duration) {
  system_ = std::make_unique<LaunchedSystem>(
      folder_,
      LaunchedSystem::Settings{.camera_address = "127.0.0.61",
                               .respawn = "{backoff_s: 0.5, longest_backoff_s: 0.5, limit: 1000}"});
  ASSERT_TRUE(listener_.WaitFor([&] { return listener_.estimates_in_a_row() >= 3; }, seconds(90)))
      << system_->launch().Output();
  std::mt19937 random(20);
  const std::vector<std::string> components{"virtual_camera", "capture", "perception",
                                            "force_estimation", "virtual_robot"};
  begin_ = Clock::now();
  duration_s_ = ToSeconds(duration);
  std::vector<std::string> round;
  while (Clock::now() - begin_ < duration) {
    if (round.empty()) {
      round = components;
      std::shuffle(round.begin(), round.end(), random);
    }
    ASSERT_NO_FATAL_FAILURE(KillAndAwait(round.back()));
    round.pop_back();
    ListenAndSample(milliseconds(500 + random() % 6000));
  }
  EXPECT_GE(returns_s_.size(), components.size()) << "each is killed at least once";
  std::printf("killed %zu times; estimates again after %.1f s on average, %.1f s at most\n",
              returns_s_.size(), Mean(returns_s_),
              *std::max_element(returns_s_.begin(), returns_s_.end()));
  for (const auto& [name, samples] : samples_) ExpectLevel(name, samples);
  system_->launch().Signal(SIGINT);
  EXPECT_EQ(system_->launch().Wait(seconds(30)), 0) << system_->launch().Output();
}

TEST_F(Soak, TwoMinutesOfKills) { Run(seconds(120)); }

TEST_F(Soak, TwentyMinutesOfKills) { Run(std::chrono::minutes(20)); }

}  // namespace
}  // namespace palpate::system_test::soak
