// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/doctor/domain_facts.hpp"

#include <unistd.h>

#include <chrono>
#include <exception>
#include <filesystem>
#include <set>

#include "components/palpate/doctor/machine_facts.hpp"
#include "components/palpate/node/live/live_messages.hpp"
#include "libs/dds/clock_offsets.hpp"
#include "libs/dds/domain.hpp"
#include "libs/dds/domain_settings.hpp"
#include "libs/dds/peers.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::command {

namespace {

using std::chrono::milliseconds;

constexpr auto kSendPeriod = milliseconds(200);
/// Discovery takes one round trip, or a process that just started a second.
constexpr auto kNobodyThere = milliseconds(1500);
/// The processes of other hosts echo once a second.
constexpr auto kLongest = milliseconds(3000);
constexpr auto kMulticastWait = milliseconds(500);

/// The interface that discovery uses: the named one, else the first that is not loopback.
const NetworkInterface* UsedInterface(const TransportFacts& facts) {
  for (const NetworkInterface& interface : facts.interfaces) {
    if (!interface.is_up || interface.addresses.empty()) continue;
    bool is_named = false;
    for (const std::string& name : facts.named) {
      is_named = is_named || name == interface.name || name == interface.addresses.front();
    }
    if (is_named || (facts.named.empty() && !interface.is_loopback)) return &interface;
  }
  return nullptr;
}

DiscoveryFacts ReadDiscovery(const dds::DomainSettings& settings, const TransportFacts& transport) {
  DiscoveryFacts facts{.uses_multicast = settings.UsesMulticast(),
                       .only_loopback = !dds::LeavesHost(settings, transport.interfaces),
                       .multicast_works = std::nullopt,
                       .interface = {},
                       .peers = settings.peers,
                       .unreachable_peers = {}};
  for (const std::string& peer : settings.peers) {
    if (LocalAddressTo(peer).empty()) facts.unreachable_peers.push_back(peer);
  }
  const NetworkInterface* used = UsedInterface(transport);
  if (used == nullptr || facts.only_loopback || !facts.uses_multicast) return facts;
  facts.interface = used->name;
  facts.multicast_works = MulticastComesBack(used->addresses.front(), kMulticastWait);
  return facts;
}

}  // namespace

NetworkSettings ReadNetworkSettings(int domain_id) {
  const std::string uri = dds::EffectiveSettings();
  const auto domain = static_cast<std::uint32_t>(domain_id);
  const dds::DomainSettings settings = dds::ReadDomainSettings(uri, domain);
  NetworkSettings network;
  TransportFacts& transport = network.transport;
  transport.settings = dds::ProcessEnvironment("CYCLONEDDS_URI").value_or("");
  transport.missing_files = settings.missing_files;
  transport.interfaces = NetworkInterfaces();
  transport.refusal = dds::RefusalOf(settings, transport.interfaces);
  transport.message_B = settings.max_message_B.value_or(0);
  for (const dds::ChosenInterface& interface : settings.interfaces) {
    if (interface.automatic) continue;
    transport.named.push_back(interface.name.empty() ? interface.address : interface.name);
  }
  network.discovery = ReadDiscovery(settings, transport);
  // Where multicast finds the processes, they have no numbers, unless they are asked for.
  network.are_indices_limited = settings.participant_index == "auto" || !settings.UsesMulticast();
  network.most_index = settings.max_participant_index;
  return network;
}

DomainMembers AskDomain(int domain_id) {
  DomainMembers members;
  members.own_messages = dds::MessagesHash();
  try {
    dds::Participant participant = JoinDomain("palpate_doctor", domain_id);
    dds::WaitSet loop(participant);
    dds::Peers peers(participant.handle());
    dds::ClockOffsets clocks(participant);
    const std::string own_host = dds::ThisHost().id;
    const auto begin = dds::WaitSet::Clock::now();
    loop.Every(kSendPeriod, [&] {
      peers.Update();
      clocks.Send({});
    });
    std::set<std::string> hosts;
    const auto done = [&] {
      hosts.clear();
      for (const auto& [guid, process] : peers.all()) {
        if (process && process->host.id != own_host) hosts.insert(process->host.name);
      }
      return dds::WaitSet::Clock::now() - begin > kNobodyThere &&
             clocks.All().size() >= hosts.size();
    };
    (void)loop.DispatchUntil(done, begin + kLongest);
    for (const auto& [guid, process] : peers.all()) {
      if (!process || (process->process_id == getpid() && process->host.id == own_host)) continue;
      members.peers.push_back({process->program, process->host.name, process->messages});
    }
    members.other_hosts.assign(hosts.begin(), hosts.end());
    for (const dds::HostClock& clock : clocks.All()) {
      members.clocks.push_back({clock.host.name, clock.offset.offset_s, clock.offset.bound_s});
    }
  } catch (const std::exception& error) {
    members.trouble = error.what();
  }
  return members;
}

}  // namespace palpate::command
