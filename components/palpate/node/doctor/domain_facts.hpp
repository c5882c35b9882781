// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/palpate/doctor/network_checks.hpp"

namespace palpate::command {

/// What CYCLONEDDS_URI and the interfaces of this host say.
struct NetworkSettings {
  TransportFacts transport;
  DiscoveryFacts discovery;
  bool are_indices_limited = true;
  int most_index = 9;
};
NetworkSettings ReadNetworkSettings(int domain_id);

/// What the processes of a domain say about themselves.
struct DomainMembers {
  std::string trouble;  ///< why the domain could not be joined; empty: it was
  std::string own_messages;
  std::vector<PeerFacts> peers;  ///< without this process
  std::vector<std::string> other_hosts;
  std::vector<ClockFacts> clocks;  ///< of those of them that answered
};

/// Joins the domain for up to three seconds.
DomainMembers AskDomain(int domain_id);

}  // namespace palpate::command
