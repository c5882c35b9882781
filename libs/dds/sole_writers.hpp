// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "libs/dds/participant.hpp"
#include "libs/dds/peers.hpp"
#include "libs/dds/publications.hpp"

namespace palpate::dds {

/// Another process writes a topic that this one alone may write.
struct WriterConflict {
  std::string reason;  ///< topic, the other process, remedy
  /// The other one was there first, and this one has just started: it is the one to go.
  bool came_later = false;
};

/// Looks for other writers of what a participant alone may write (sole_writer in the topic table),
/// under its resolved names, so that namespaces do not meet. Writers of a process that has ended
/// without leaving DDS do not count: where it ran on this machine, at once, else until DDS drops
/// them (LeaseDuration).
class SoleWriters {
 public:
  using Clock = std::chrono::steady_clock;

  /// `participant` must outlive this. Throws RunError where DDS refuses.
  SoleWriters(const Participant& participant, Clock::time_point start);

  /// To be called now and then. nullopt: this process is the only writer of its topics.
  std::optional<WriterConflict> Find(Clock::time_point now);

  /// The process that writes a topic, by its ROS name; nullopt: none does, or it does not tell.
  std::optional<ProcessIdentity> WriterOf(const std::string& ros_name);

 private:
  bool IsOwnTopic(const std::string& dds_topic) const;
  bool CameLater(const Guid& other, const std::optional<ProcessIdentity>& process,
                 Clock::time_point now) const;

  const Participant& participant_;
  Clock::time_point start_;
  Guid guid_{};
  Peers peers_;
  Publications publications_;
  std::map<Guid, Clock::time_point> first_seen_;  ///< conflicting writers
};

}  // namespace palpate::dds
