// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/sole_writers.hpp"

#include "libs/dds/ros_names.hpp"

namespace palpate::dds {

namespace {

/// A process that is so young ends where it is the second; an older one goes on and says so.
constexpr auto kStart = std::chrono::seconds(30);
/// DDS drops a process that ended without leaving after at most 20 s (LeaseDuration in
/// config/cyclonedds).
constexpr auto kLease = std::chrono::seconds(22);

/// "rt/forces" -> "/forces"
std::string RosName(const std::string& dds_topic) { return dds_topic.substr(2); }

/// MayRun() knows whether it runs: not of another machine, nor of another container.
bool IsNumberedHere(const ProcessIdentity& process) {
  const ProcessIdentity own = ThisProcess();
  return process.host.id == own.host.id && process.process_namespace == own.process_namespace;
}

bool IsThisProcess(const ProcessIdentity& process) {
  return IsNumberedHere(process) && process.process_id == ThisProcess().process_id;
}

std::string Named(const std::optional<ProcessIdentity>& process) {
  if (!process) return "a process of another program";
  return process->program + " (process " + std::to_string(process->process_id) + " on host " +
         process->host.name + ")";
}

}  // namespace

SoleWriters::SoleWriters(const Participant& participant, Clock::time_point start)
    : participant_(participant),
      start_(start),
      peers_(participant.handle()),
      publications_(participant.handle(), [](const std::string&) { return false; }) {
  dds_guid_t guid;
  if (dds_get_guid(participant.handle(), &guid) == DDS_RETCODE_OK) guid_ = ToArray(guid);
}

bool SoleWriters::IsOwnTopic(const std::string& dds_topic) const {
  for (const Participant::Written& topic : participant_.written()) {
    if (topic.sole_writer && DdsTopicName(topic.ros_name) == dds_topic) return true;
  }
  return false;
}

bool SoleWriters::CameLater(const Guid& other, const std::optional<ProcessIdentity>& process,
                            Clock::time_point now) const {
  if (now - start_ > kStart) return false;
  if (!process) return true;
  const std::int64_t own_start_ns = ThisProcess().start_ns;
  return own_start_ns > process->start_ns || (own_start_ns == process->start_ns && guid_ > other);
}

std::optional<ProcessIdentity> SoleWriters::WriterOf(const std::string& ros_name) {
  peers_.Update();
  (void)publications_.Update();
  const std::string dds_topic = DdsTopicName(ros_name);
  for (const auto& [guid, publication] : publications_.all()) {
    if (publication.dds_topic != dds_topic) continue;
    const auto peer = peers_.all().find(publication.participant);
    if (peer != peers_.all().end() && peer->second && MayRun(*peer->second)) return peer->second;
  }
  return std::nullopt;
}

std::optional<WriterConflict> SoleWriters::Find(Clock::time_point now) {
  peers_.Update();
  (void)publications_.Update();
  std::map<Guid, Clock::time_point> seen;
  std::optional<WriterConflict> conflict;
  for (const auto& [guid, publication] : publications_.all()) {
    if (!IsOwnTopic(publication.dds_topic)) continue;
    const auto peer = peers_.all().find(publication.participant);
    if (peer == peers_.all().end()) continue;
    if (peer->second && (IsThisProcess(*peer->second) || !MayRun(*peer->second))) continue;
    const auto known = first_seen_.find(guid);
    seen[guid] = known == first_seen_.end() ? now : known->second;
    const bool is_sure = peer->second && IsNumberedHere(*peer->second);
    const bool came_later = (is_sure || now - seen[guid] > kLease) &&
                            CameLater(publication.participant, peer->second, now);
    if (conflict && (conflict->came_later || !came_later)) continue;
    conflict = WriterConflict{
        .reason = "two processes write " + RosName(publication.dds_topic) + ": this one and " +
                  Named(peer->second) +
                  "; stop one of them, or start one with --domain or --remap __ns:=/NAME",
        .came_later = came_later};
  }
  first_seen_ = std::move(seen);
  return conflict;
}

}  // namespace palpate::dds
