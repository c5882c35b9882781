// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/clock_offsets.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "libs/core/seconds.hpp"
#include "libs/dds/peers.hpp"
#include "libs/dds/qos.hpp"
#include "libs/dds/ros_names.hpp"

namespace palpate::dds {

namespace {

using Exchange = idl::palpate_msgs::ClockExchange;

/// A process that was silent for so long has ended.
constexpr double kForgotten_s = 10.0;

struct DeleteExchangeListener {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

std::string ToText(const char* field) { return std::string(Text(field)); }

/// The participant's GUID in hex: unique.
std::string NameOf(dds_entity_t participant) {
  dds_guid_t guid{};
  if (dds_get_guid(participant, &guid) != DDS_RETCODE_OK) return {};
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string name;
  for (const std::uint8_t octet : guid.v) {
    name += kDigits[octet >> 4U];
    name += kDigits[octet & 0xFU];
  }
  return name;
}

bool Contains(const std::vector<std::string>& topics, std::string_view topic) {
  return std::find(topics.begin(), topics.end(), topic) != topics.end();
}

}  // namespace

ClockOffsets::ClockOffsets(Participant& participant, Host host, Clock wall)
    : host_(std::move(host)),
      wall_(std::move(wall)),
      process_(NameOf(participant.handle())),
      writer_(participant.CreateWriter(kClockExchangeTopic)) {
  const TopicSettings& row = participant.table().At(kClockExchangeTopic.name);
  const dds_topic_descriptor_t& descriptor = idl::MessageTraits<Exchange>::Descriptor();
  const std::string name = DdsTopicName(writer_.ros_name());
  topic_ = Entity(
      dds_create_topic(participant.handle(), &descriptor, name.c_str(), nullptr, nullptr), name);
  const std::unique_ptr<dds_listener_t, DeleteExchangeListener> listener(dds_create_listener(this));
  dds_lset_data_available(listener.get(), OnData);
  reader_ = Entity(dds_create_reader(participant.handle(), topic_.handle(), ReaderQos(row).get(),
                                     listener.get()),
                   "reader of " + row.name);
}

void ClockOffsets::OnData(dds_entity_t reader, void* self) {
  auto& offsets = *static_cast<ClockOffsets*>(self);
  const std::int64_t now_ns = offsets.wall_();
  for (const Exchange& message : Samples<Exchange>(reader)) offsets.Take(message, now_ns);
}

void ClockOffsets::Take(const Exchange& message, std::int64_t received_ns) {
  if (Text(message.process) == process_) return;
  const std::lock_guard lock(mutex_);
  Peer& peer = peers_[ToText(message.process)];
  peer.host = {ToText(message.host), ToText(message.host_name)};
  peer.sent_ns = message.sent_ns;
  peer.received_ns = received_ns;
  peer.stamped_topics.clear();
  for (const char* topic : Elements(message.stamped_topics)) {
    peer.stamped_topics.push_back(ToText(topic));
  }
  for (const auto& echo : Elements(message.echoes)) {
    if (Text(echo.process) != process_) continue;
    (void)peer.filter.Add({.sent_ns = echo.sent_ns,
                           .received_ns = echo.received_ns,
                           .returned_ns = message.sent_ns,
                           .returned_to_ns = received_ns});
  }
}

void ClockOffsets::Send(const std::vector<std::string>& stamped_topics) {
  Message<Exchange> message;
  // Not held while writing: DDS calls Take() with locks that a writer waits for.
  std::unique_lock lock(mutex_);
  own_topics_ = stamped_topics;
  const std::int64_t now_ns = wall_();
  std::erase_if(peers_, [&](const auto& entry) {
    return NsToSeconds(now_ns - entry.second.received_ns) > kForgotten_s;
  });
  SetText(message->process, process_);
  SetText(message->host, host_.id);
  SetText(message->host_name, host_.name);
  Resize(message->stamped_topics, stamped_topics.size());
  for (std::size_t i = 0; i < stamped_topics.size(); ++i) {
    SetText(message->stamped_topics._buffer[i], stamped_topics[i]);
  }
  const auto elsewhere = [&](const auto& entry) { return entry.second.host.id != host_.id; };
  Resize(message->echoes,
         static_cast<std::size_t>(std::count_if(peers_.begin(), peers_.end(), elsewhere)));
  std::size_t i = 0;
  for (const auto& [process, peer] : peers_) {
    if (peer.host.id == host_.id) continue;
    auto& echo = message->echoes._buffer[i++];
    SetText(echo.process, process);
    echo.sent_ns = peer.sent_ns;
    echo.received_ns = peer.received_ns;
  }
  lock.unlock();
  message->sent_ns = wall_();
  // The next one follows in a second.
  (void)writer_.Write(message);
}

std::optional<ClockOffset> ClockOffsets::Best(const std::string& host_id,
                                              std::int64_t now_ns) const {
  if (host_id == host_.id) return ClockOffset{};
  std::optional<ClockOffset> best;
  for (const auto& [process, peer] : peers_) {
    if (peer.host.id != host_id) continue;
    const auto offset = peer.filter.At(now_ns);
    if (offset && (!best || offset->bound_s < best->bound_s)) best = offset;
  }
  return best;
}

std::vector<HostClock> ClockOffsets::All() const {
  const std::lock_guard lock(mutex_);
  const std::int64_t now_ns = wall_();
  std::map<std::string, HostClock> clocks;
  for (const auto& [process, peer] : peers_) {
    if (peer.host.id == host_.id) continue;
    if (NsToSeconds(now_ns - peer.received_ns) > kForgotten_s) continue;
    if (const auto best = Best(peer.host.id, now_ns)) clocks[peer.host.id] = {peer.host, *best};
  }
  std::vector<HostClock> list;
  for (const auto& [id, clock] : clocks) list.push_back(clock);
  return list;
}

std::optional<ClockOffset> ClockOffsets::OfHost(const std::string& host_id) const {
  const std::lock_guard lock(mutex_);
  return Best(host_id, wall_());
}

std::optional<ClockOffset> ClockOffsets::Of(std::string_view topic) const {
  const std::lock_guard lock(mutex_);
  if (Contains(own_topics_, topic)) return ClockOffset{};
  const std::int64_t now_ns = wall_();
  for (const auto& [process, peer] : peers_) {
    if (Contains(peer.stamped_topics, topic)) return Best(peer.host.id, now_ns);
  }
  return std::nullopt;
}

}  // namespace palpate::dds
