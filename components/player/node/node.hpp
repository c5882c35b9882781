// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <optional>
#include <string>

#include "components/player/config.hpp"
#include "components/player/experiment_player.hpp"
#include "components/player/node/image_publisher.hpp"
#include "components/player/pacer.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::player {

using NodeConfig = dds::WithNodeSettings<Config>;

/// How the events follow each other.
struct Playback {
  double rate = 1.0;  ///< 1: real time; infinity: as fast as possible
  bool step = false;  ///< the next frame when /forces answered the last one: nothing is lost
  bool loop = false;  ///< begin again at the end
};

/// Publishes an experiment on /perception/markers, or as a camera would, and /robot/joint_states.
class PlayerNode {
 public:
  /// Throws InputError for bad settings, RunError where DDS refuses.
  PlayerNode(const NodeConfig& config, const Playback& playback, ExperimentPlayer player,
             int domain_id, dds::TopicTable table, dds::NodeLog::ProcessLog process_log);

  /// Plays to the end, or until Stop(). Throws RunError where a reader is missing, or with --step
  /// none answers, within the deadlines.
  void Run();
  /// From any thread.
  void Stop() { loop_.Stop(); }

  uint64_t frames_played() const { return counts_.published; }

 private:
  using Time = dds::WaitSet::Clock::time_point;

  void WaitForReaders();
  void Settle();
  bool ReadersAreThere() const;
  void PlayAll();
  void Play(const Event& event);
  void WaitForAnswer(const Event& event);
  bool Answered(const Event& event) const;
  void Publish(const Event& event);
  bool PublishImages(const Event& event, std::int64_t stamp_ns);
  void ConfirmFirst(const Event& event);
  bool WaitUntilReceived(std::chrono::nanoseconds at_most);
  void TakeForces();
  void PublishClock(int64_t now_ns);
  void AdvanceClock();
  bool NewEstimator() const;
  void Rewind();
  void ReportHealth();

  NodeConfig config_;
  Playback playback_;
  ExperimentPlayer player_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  dds::Writer<idl::palpate_msgs::MarkerArray3> markers_;
  std::optional<ImagePublisher> images_;           ///< where images are played
  std::map<std::string, ImagePublisher> further_;  ///< of the cameras beside the first, by name
  dds::Writer<idl::sensor_msgs::JointState> joint_states_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  std::optional<dds::Writer<idl::rosgraph_msgs::Clock>> clock_;  ///< with publish_clock
  int64_t event_ns_ = 0;                                         ///< stamp of the last event
  std::string event_recording_;
  Time event_time_;                       ///< when it was published
  std::optional<int64_t> next_event_ns_;  ///< /clock does not pass it; nullopt: time stands
  Pacer pacer_;
  dds::HealthCounts counts_;
  bool is_confirmed_ = false;  ///< by the readers, the first frame since WaitForReaders()
  uint32_t known_estimators_ = 0;
  std::string answered_recording_;
  std::optional<int64_t> answered_stamp_ns_;
};

}  // namespace palpate::player
