// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/network_checks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

constexpr std::int64_t kMiB = 1024 * 1024;
/// What config/cyclonedds asks for.
constexpr std::int64_t kWantedBuffer_B = 10 * kMiB;
/// Depth and colour of one frame: less loses most of each.
constexpr std::int64_t kFrame_B = 2'000'000;
/// Headers of IP and UDP.
constexpr std::int64_t kHeaders_B = 28;
/// Fits into the MTU of plain Ethernet, 1500 B.
constexpr std::int64_t kOfUsualMtu_B = 1472;
/// Offset from which force estimation takes cable inputs and images of two times.
constexpr double kLargeOffset_s = 0.005;

Check Graded(const std::string& name, Grade grade, const std::string& finding,
             const std::string& remedy = {}) {
  return {.name = name, .grade = grade, .finding = finding, .remedy = remedy};
}

bool Matches(const NetworkInterface& interface, const std::string& name) {
  return interface.name == name || std::find(interface.addresses.begin(), interface.addresses.end(),
                                             name) != interface.addresses.end();
}

std::string AddressesOf(const NetworkInterface& interface) {
  return interface.name + " (" + Listed(interface.addresses) + ")";
}

Check JudgeMtu(const TransportFacts& facts, const NetworkInterface& interface) {
  const std::string finding =
      fmt::format("{}, packets up to {} B", AddressesOf(interface), interface.mtu_B);
  if (facts.message_B + kHeaders_B <= interface.mtu_B) {
    return Graded("interface", Grade::kOk, finding);
  }
  return Graded("interface", Grade::kFailure,
                finding + fmt::format(", but datagrams have up to {} B with their headers",
                                      facts.message_B + kHeaders_B),
                facts.message_B > kOfUsualMtu_B
                    ? "sudo ip link set dev " + interface.name +
                          " mtu 9000 on all hosts, or take config/cyclonedds/lan.xml"
                    : fmt::format("append to CYCLONEDDS_URI: ,<General><MaxMessageSize>{}B"
                                  "</MaxMessageSize></General>",
                                  interface.mtu_B - kHeaders_B));
}

std::string Milliseconds(double seconds) { return fmt::format("{:+.1f} ms", 1e3 * seconds); }

}  // namespace

Check CheckReceiveBuffer(std::optional<std::int64_t> rmem_max_B) {
  const std::string name = "receive buffers";
  if (!rmem_max_B) return Graded(name, Grade::kWarning, "net.core.rmem_max cannot be read");
  const std::string finding =
      fmt::format("net.core.rmem_max {:.1f} MB", static_cast<double>(*rmem_max_B) / 1e6);
  if (*rmem_max_B >= kWantedBuffer_B) return Graded(name, Grade::kOk, finding);
  const std::string remedy = fmt::format(
      "sudo sysctl -w net.core.rmem_max={} (for good: echo "
      "net.core.rmem_max={} | sudo tee /etc/sysctl.d/60-palpate.conf)",
      kWantedBuffer_B, kWantedBuffer_B);
  const bool loses = *rmem_max_B < kFrame_B;
  return Graded(name, loses ? Grade::kFailure : Grade::kWarning,
                finding + (loses ? ", less than one frame: images are lost"
                                 : ", two frames at once are lost"),
                remedy);
}

Check CheckDomain(const DomainFacts& facts) {
  const std::string name = "domain";
  if (!facts.trouble.empty()) {
    return Graded(name, Grade::kFailure, facts.trouble, "export ROS_DOMAIN_ID=0");
  }
  // RTPS 2.3, section 9.6.1.1: ports of a domain.
  constexpr int kBase = 7400;
  constexpr int kPerDomain = 250;
  const int last_port = kBase + kPerDomain * (facts.domain_id + 1) - 1;
  const std::string finding = fmt::format("{}", facts.domain_id);
  if (last_port < facts.first_ephemeral_port) return Graded(name, Grade::kOk, finding);
  return Graded(name, Grade::kWarning,
                finding + fmt::format(": its ports up to {} are also given to other programs "
                                      "(from {})",
                                      last_port, facts.first_ephemeral_port),
                fmt::format("take a domain from 0 to {}",
                            (facts.first_ephemeral_port - kBase) / kPerDomain - 1));
}

Check CheckSettings(const TransportFacts& facts) {
  const std::string name = "DDS settings";
  if (!facts.missing_files.empty()) {
    return Graded(name, Grade::kFailure,
                  "CYCLONEDDS_URI names " + facts.missing_files.front() + ", which is not there",
                  "unset CYCLONEDDS_URI, or name one of config/cyclonedds");
  }
  if (!facts.refusal.empty()) return Graded(name, Grade::kFailure, facts.refusal);
  return Graded(name, Grade::kOk,
                facts.settings.empty() ? "built in (config/cyclonedds/default.xml)"
                                       : Excerpt(facts.settings));
}

Check CheckInterface(const TransportFacts& facts) {
  const std::string name = "interface";
  std::vector<const NetworkInterface*> up;
  for (const NetworkInterface& interface : facts.interfaces) {
    const bool is_usable = interface.is_up && !interface.addresses.empty();
    if (is_usable && !interface.is_loopback) up.push_back(&interface);
  }
  for (const std::string& named : facts.named) {
    const auto found = std::find_if(facts.interfaces.begin(), facts.interfaces.end(),
                                    [&](const auto& one) { return Matches(one, named); });
    std::vector<std::string> there;
    for (const NetworkInterface* interface : up) there.push_back(AddressesOf(*interface));
    if (found == facts.interfaces.end()) {
      return Graded(name, Grade::kFailure, "'" + named + "' is not there",
                    "export PALPATE_INTERFACE=NAME, one of: lo, " + Listed(there));
    }
    if (!found->is_up) {
      return Graded(name, Grade::kFailure, named + " is down",
                    "sudo ip link set dev " + found->name + " up");
    }
    return JudgeMtu(facts, *found);
  }
  if (up.empty()) return Graded(name, Grade::kOk, "none but loopback: one host alone");
  if (up.size() == 1) return JudgeMtu(facts, *up.front());
  std::vector<std::string> names;
  for (const NetworkInterface* interface : up) names.push_back(AddressesOf(*interface));
  return Graded(
      name, Grade::kWarning,
      fmt::format("{} are up, and Cyclone DDS takes any of them: {}", up.size(), Listed(names)),
      "export PALPATE_INTERFACE=" + up.front()->name);
}

Check CheckDiscovery(const DiscoveryFacts& facts) {
  const std::string name = "discovery";
  if (!facts.unreachable_peers.empty()) {
    return Graded(name, Grade::kFailure, "there is no route to " + Listed(facts.unreachable_peers),
                  "ip route get " + facts.unreachable_peers.front());
  }
  if (facts.only_loopback) return Graded(name, Grade::kOk, "on this host alone");
  if (!facts.uses_multicast) {
    const auto is_elsewhere = [](const std::string& peer) { return !peer.starts_with("127."); };
    if (std::none_of(facts.peers.begin(), facts.peers.end(), is_elsewhere)) {
      return Graded(name, Grade::kWarning, "without multicast, and no other host is named",
                    "export PALPATE_PEERS=ADDRESS,ADDRESS");
    }
    return Graded(name, Grade::kOk, "unicast to " + Listed(facts.peers));
  }
  const std::string on = facts.interface.empty() ? "" : " on " + facts.interface;
  if (!facts.multicast_works) return Graded(name, Grade::kOk, "multicast" + on + ", not tried");
  if (*facts.multicast_works) return Graded(name, Grade::kOk, "multicast" + on);
  return Graded(name, Grade::kFailure, "multicast" + on + " does not come back",
                "sudo ip link set dev " + (facts.interface.empty() ? "NAME" : facts.interface) +
                    " multicast on, open UDP in the firewall, or take "
                    "config/cyclonedds/lossy_link.xml with PALPATE_PEERS");
}

Check CheckParticipants(const ParticipantFacts& facts) {
  const std::string name = "participants";
  if (!facts.trouble.empty()) {
    return Graded(name, Grade::kFailure, facts.trouble, "see DDS settings and interface above");
  }
  if (!facts.are_numbered) {
    return Graded(name, Grade::kOk, fmt::format("{} on this host, without limit", facts.used));
  }
  const std::string finding = fmt::format("{} of {} on this host", facts.used, facts.limit + 1);
  const bool full = facts.used > facts.limit;
  if (!full && 5 * facts.used < 4 * (facts.limit + 1)) return Graded(name, Grade::kOk, finding);
  return Graded(name, full ? Grade::kFailure : Grade::kWarning, finding,
                "stop processes of this domain, or raise Discovery/MaxAutoParticipantIndex");
}

Check CheckVersions(const std::vector<PeerFacts>& peers, const std::string& own_messages) {
  const std::string name = "versions";
  std::set<std::string> hosts;
  std::vector<std::string> others;
  for (const PeerFacts& peer : peers) {
    hosts.insert(peer.host);
    if (peer.messages != own_messages) others.push_back(peer.program + " on " + peer.host);
  }
  if (others.empty()) {
    return Graded(name, Grade::kOk,
                  peers.empty()
                      ? "no other process of palpate in the domain"
                      : fmt::format("{} processes on {} hosts, all with the same messages",
                                    peers.size(), hosts.size()));
  }
  return Graded(name, Grade::kFailure,
                "these have other messages than this build: " + Listed(others),
                "install the same version on all hosts and restart them");
}

Check CheckClocks(const std::vector<ClockFacts>& clocks,
                  const std::vector<std::string>& other_hosts) {
  const std::string name = "clocks";
  if (other_hosts.empty()) return Graded(name, Grade::kOk, "no other host in the domain");
  std::vector<std::string> texts;
  std::vector<std::string> unknown = other_hosts;
  const ClockFacts* worst = nullptr;
  for (const ClockFacts& clock : clocks) {
    texts.push_back(fmt::format("{} {} +- {:.1f} ms", clock.host, Milliseconds(clock.offset_s),
                                1e3 * clock.bound_s));
    std::erase(unknown, clock.host);
    const bool is_large = std::abs(clock.offset_s) - clock.bound_s > kLargeOffset_s;
    if (is_large && (!worst || std::abs(clock.offset_s) > std::abs(worst->offset_s))) {
      worst = &clock;
    }
  }
  for (const std::string& host : unknown) texts.push_back(host + " does not answer");
  if (worst != nullptr) {
    return Graded(name, Grade::kWarning, Listed(texts),
                  "on " + worst->host + ": sudo apt install chrony && sudo chronyc makestep");
  }
  if (!unknown.empty()) {
    return Graded(name, Grade::kWarning, Listed(texts), "ping " + unknown.front());
  }
  return Graded(name, Grade::kOk, Listed(texts));
}

}  // namespace palpate::command
