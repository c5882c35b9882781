// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/player/config.hpp"
#include "components/player/node/answers.hpp"
#include "components/player/node/played_writers.hpp"
#include "components/player/playback_clock.hpp"
#include "components/player/playback_state.hpp"
#include "components/player/recording_source.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::player {

/// How a message file is played.
struct RecordingPlan {
  double rate = 1.0;                 ///< > 0; infinity: as fast as possible
  bool step = false;                 ///< the next frame when /forces answered the last one
  bool loop = false;                 ///< begin again at the end
  bool paused = false;               ///< at the start
  double start_s = 0.0;              ///< from the beginning of the recording
  std::optional<double> end_s = {};  ///< from there, too; nullopt: to its end
  std::string step_topic = {};       ///< whose messages are steps; empty: see Run()
  int step_count = 1;                ///< of its messages, for one request
  bool beside_writers = false;       ///< mix with topics that live writers publish
  /// Is given the state once a second and at the end; may be empty.
  std::function<void(const PlaybackState&)> show = {};
};

enum class Request { kPauseOrResume, kStep, kForward, kBack, kFaster, kSlower };

/// Plays a recording of messages of any type.
class RecordingNode {
 public:
  /// Throws InputError for bad settings, RunError where DDS refuses.
  RecordingNode(const dds::WithNodeSettings<Config>& config, RecordingPlan plan,
                RecordingSource source, int domain_id, dds::TopicTable table,
                dds::NodeLog::ProcessLog process_log);

  /// Plays to the end, or until Stop(). Where no topic is named, steps are those of the markers,
  /// else of the contacts, else of the depth images. Throws RunError where nobody reads, with
  /// `step` nobody answers, or live writers publish what is to be played.
  void Run();
  /// Both from any thread.
  void Stop() { loop_.Stop(); }
  void Ask(Request request);

  /// From the thread of Run() only.
  PlaybackState State() const;

 private:
  enum class Due { kNow, kMoved, kStopped };

  void WaitForReaders();
  void Settle();
  void RefuseLiveTopics();
  void PlayOnce();
  Due WaitUntilDue(const PlayedMessage& message);
  void DispatchInBetween();
  bool TakeRequest();
  void MoveTo(std::int64_t time_ns);
  void Send(const PlayedMessage& message);
  void ConfirmFirst(const PlayedMessage& message);
  void ChooseScheduling();
  bool IsStep(std::size_t topic) const { return !step_topic_ || *step_topic_ == topic; }
  void ChooseStepTopic();
  void WaitForAnswer();
  void PublishClock();
  void Report();
  std::int64_t Begin_ns() const;
  std::int64_t End_ns() const;

  dds::WithNodeSettings<Config> config_;
  RecordingPlan plan_;
  RecordingSource source_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  PlayedWriters writers_;
  std::optional<Answers> answers_;  ///< with step
  std::optional<dds::Writer<idl::rosgraph_msgs::Clock>> clock_writer_;
  PlaybackClock clock_;
  std::optional<std::size_t> step_topic_;
  bool is_playing_ = false;
  dds::WaitSet::Clock::time_point first_sent_;  ///< when playing began; epoch: not yet
  int steps_left_ = 0;                          ///< messages to be sent while time stands
  std::int64_t position_ns_ = 0;
  dds::WaitSet::Clock::time_point next_dispatch_;
  std::uint64_t messages_ = 0;
  std::uint64_t dropped_ = 0;
  std::vector<double> lateness_s_;  ///< of this pass
  std::vector<double> recent_lateness_s_;
  std::mutex mutex_;
  std::vector<Request> requests_;
};

/// The built-in rows and one for each played topic that they lack, so that names are resolved for
/// all alike.
dds::TopicTable TableOf(const dds::TopicTable& table, const std::vector<PlayedTopic>& topics);

}  // namespace palpate::player
