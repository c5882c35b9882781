// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/palpate/doctor/check.hpp"
#include "libs/core/network_interfaces.hpp"

/// What `palpate doctor` checks of the network, from facts that tests can make up.
namespace palpate::command {

/// Kernel's limit of receive buffers, and losses of UDP.
Check CheckReceiveBuffer(std::optional<std::int64_t> rmem_max_B);

struct DomainFacts {
  std::string trouble;  ///< why ROS_DOMAIN_ID is no domain; empty: it is
  int domain_id = 0;
  int first_ephemeral_port = 32768;  ///< net.ipv4.ip_local_port_range
};

/// The domain, and that the kernel does not give its ports to other programs.
Check CheckDomain(const DomainFacts& facts);

/// The settings of Cyclone DDS and the interfaces that they choose from.
struct TransportFacts {
  std::string settings;                      ///< CYCLONEDDS_URI; empty: built in
  std::vector<std::string> missing_files;    ///< of it
  std::string refusal;                       ///< why processes refuse to start; empty: they do not
  std::vector<NetworkInterface> interfaces;  ///< of this host
  std::vector<std::string> named;            ///< names or addresses of interfaces in the settings
  std::int64_t message_B = 0;                ///< largest datagram; 0: Cyclone DDS's default
};

/// Settings that can be read and do not contradict each other.
Check CheckSettings(const TransportFacts& facts);
/// The interface: there, up, only one or named, its MTU above the datagrams.
Check CheckInterface(const TransportFacts& facts);

struct DiscoveryFacts {
  bool uses_multicast = true;
  bool only_loopback = false;           ///< messages do not leave this host
  std::optional<bool> multicast_works;  ///< a datagram to oneself; nullopt: not tried
  std::string interface;                ///< on which
  std::vector<std::string> peers;       ///< of the settings
  std::vector<std::string> unreachable_peers;
};

/// How processes find each other.
Check CheckDiscovery(const DiscoveryFacts& facts);

struct ParticipantFacts {
  std::string trouble;       ///< why the domain could not be joined; empty: it was
  bool are_numbered = true;  ///< participant indices are limited
  int used = 0;
  int limit = 60;  ///< MaxAutoParticipantIndex
};

/// Room for further processes in the domain on this host.
Check CheckParticipants(const ParticipantFacts& facts);

/// A process of ours in the domain.
struct PeerFacts {
  std::string program;
  std::string host;
  std::string messages;  ///< hash of the structure of all messages of its build
};

/// All processes of the domain understand each other.
Check CheckVersions(const std::vector<PeerFacts>& peers, const std::string& own_messages);

/// The clock of another host.
struct ClockFacts {
  std::string host;
  double offset_s = 0.0;
  double bound_s = 0.0;
};

/// `other_hosts`: hosts of the domain; those without a clock could not be measured.
Check CheckClocks(const std::vector<ClockFacts>& clocks,
                  const std::vector<std::string>& other_hosts);

}  // namespace palpate::command
