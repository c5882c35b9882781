// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/network_checks.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/components/palpate/doctor/check_matcher.hpp"

namespace palpate::command {
namespace {

using testing::HasSubstr;

NetworkInterface Interface(const std::string& name, const std::string& address, int mtu_B = 1500) {
  return {.name = name,
          .addresses = {address},
          .is_up = true,
          .is_loopback = name == "lo",
          .has_multicast = true,
          .mtu_B = mtu_B};
}

TransportFacts Lan() {
  return {.settings = {},
          .missing_files = {},
          .refusal = {},
          .interfaces = {Interface("eth0", "192.0.2.7"), Interface("lo", "127.0.0.1", 65536)},
          .named = {},
          .message_B = 1400};
}

TEST(DoctorNetwork, ReceiveBuffersHoldTwoFrames) {
  EXPECT_THAT(CheckReceiveBuffer(16777216), Is(Grade::kOk, "net.core.rmem_max 16.8 MB"));
  EXPECT_THAT(CheckReceiveBuffer(4194304),
              Is(Grade::kWarning, "4.2 MB", "sudo sysctl -w net.core.rmem_max=10485760"));
  EXPECT_THAT(CheckReceiveBuffer(212992),
              Is(Grade::kFailure, "0.2 MB, less than one frame", "/etc/sysctl.d/60-palpate.conf"));
  EXPECT_THAT(CheckReceiveBuffer(std::nullopt), Is(Grade::kWarning, "cannot be read"));
}

TEST(DoctorNetwork, TheDomainHasPortsOfItsOwn) {
  EXPECT_THAT(CheckDomain({}), Is(Grade::kOk, "0"));
  EXPECT_THAT(CheckDomain({.trouble = {}, .domain_id = 100, .first_ephemeral_port = 32768}),
              Is(Grade::kOk, "100"));
  EXPECT_THAT(CheckDomain({.trouble = {}, .domain_id = 110, .first_ephemeral_port = 32768}),
              Is(Grade::kWarning, "other programs (from 32768)", "take a domain from 0 to 100"));
  EXPECT_THAT(CheckDomain({.trouble = "ROS_DOMAIN_ID: must be 0 to 232, not 'x'"}),
              Is(Grade::kFailure, "ROS_DOMAIN_ID", "export ROS_DOMAIN_ID=0"));
}

TEST(DoctorNetwork, SettingsAreThereAndDoNotContradictEachOther) {
  TransportFacts facts = Lan();
  EXPECT_THAT(CheckSettings(facts), Is(Grade::kOk, "built in"));
  facts.settings = "file:///etc/a.xml";
  EXPECT_THAT(CheckSettings(facts), Is(Grade::kOk, "file:///etc/a.xml"));
  facts.refusal = "/etc/a.xml:7: shared memory passes by DDS Security";
  EXPECT_THAT(CheckSettings(facts), Is(Grade::kFailure, "/etc/a.xml:7: shared memory"));
  facts.missing_files = {"/etc/a.xml"};
  EXPECT_THAT(CheckSettings(facts),
              Is(Grade::kFailure, "/etc/a.xml, which is not there", "unset CYCLONEDDS_URI"));
}

TEST(DoctorNetwork, TheInterfaceIsKnownUpAndPassesTheDatagrams) {
  EXPECT_THAT(CheckInterface(Lan()), Is(Grade::kOk, "eth0 (192.0.2.7), packets up to 1500 B"));
  TransportFacts facts = Lan();
  facts.message_B = 8900;
  EXPECT_THAT(CheckInterface(facts), Is(Grade::kFailure, "datagrams have up to 8928 B",
                                        "sudo ip link set dev eth0 mtu 9000"));
  facts = Lan();
  facts.interfaces[0].mtu_B = 1400;
  EXPECT_THAT(CheckInterface(facts),
              Is(Grade::kFailure, "up to 1428 B", "<MaxMessageSize>1372B</MaxMessageSize>"));
  facts = Lan();
  facts.interfaces.push_back(Interface("wlan0", "198.51.100.3"));
  EXPECT_THAT(CheckInterface(facts), Is(Grade::kWarning, "2 are up, and Cyclone DDS takes any",
                                        "export PALPATE_INTERFACE=eth0"));
  facts.named = {"198.51.100.3"};
  EXPECT_THAT(CheckInterface(facts), Is(Grade::kOk, "wlan0"));
  facts.named = {"eth9"};
  EXPECT_THAT(CheckInterface(facts),
              Is(Grade::kFailure, "'eth9' is not there", "one of: lo, eth0 (192.0.2.7), wlan0"));
  facts.named = {"eth0"};
  facts.interfaces[0].is_up = false;
  EXPECT_THAT(CheckInterface(facts),
              Is(Grade::kFailure, "eth0 is down", "sudo ip link set dev eth0 up"));
  facts.named = {};
  facts.interfaces = {Interface("lo", "127.0.0.1", 65536)};
  EXPECT_THAT(CheckInterface(facts), Is(Grade::kOk, "one host alone"));
}

TEST(DoctorNetwork, ProcessesFindEachOther) {
  DiscoveryFacts facts;
  facts.interface = "eth0";
  facts.multicast_works = true;
  EXPECT_THAT(CheckDiscovery(facts), Is(Grade::kOk, "multicast on eth0"));
  facts.multicast_works = false;
  EXPECT_THAT(CheckDiscovery(facts), Is(Grade::kFailure, "multicast on eth0 does not come back",
                                        "config/cyclonedds/lossy_link.xml"));
  facts.uses_multicast = false;
  EXPECT_THAT(CheckDiscovery(facts),
              Is(Grade::kWarning, "no other host is named", "export PALPATE_PEERS="));
  facts.peers = {"127.0.0.1", "10.0.0.2"};
  EXPECT_THAT(CheckDiscovery(facts), Is(Grade::kOk, "unicast to 127.0.0.1, 10.0.0.2"));
  facts.unreachable_peers = {"10.0.0.2"};
  EXPECT_THAT(CheckDiscovery(facts),
              Is(Grade::kFailure, "no route to 10.0.0.2", "ip route get 10.0.0.2"));
  facts = {};
  facts.only_loopback = true;
  EXPECT_THAT(CheckDiscovery(facts), Is(Grade::kOk, "this host alone"));
}

TEST(DoctorNetwork, FurtherProcessesHaveRoom) {
  ParticipantFacts facts{.trouble = {}, .are_numbered = true, .used = 9, .limit = 60};
  EXPECT_THAT(CheckParticipants(facts), Is(Grade::kOk, "9 of 61"));
  facts.used = 50;
  EXPECT_THAT(CheckParticipants(facts), Is(Grade::kWarning, "50 of 61", "MaxAutoParticipantIndex"));
  facts.used = 61;
  EXPECT_THAT(CheckParticipants(facts), Is(Grade::kFailure, "61 of 61", "stop processes"));
  facts.are_numbered = false;
  EXPECT_THAT(CheckParticipants(facts), Is(Grade::kOk, "61 on this host, without limit"));
  facts.trouble = "cannot create a participant";
  EXPECT_THAT(CheckParticipants(facts), Is(Grade::kFailure, "cannot create", "above"));
}

TEST(DoctorNetwork, AllProcessesHaveTheSameMessages) {
  const PeerFacts same{"palpate-capture", "camera", "abc"};
  EXPECT_THAT(CheckVersions({}, "abc"), Is(Grade::kOk, "no other process"));
  EXPECT_THAT(CheckVersions({same, same}, "abc"), Is(Grade::kOk, "2 processes on 1 hosts"));
  EXPECT_THAT(CheckVersions({same, {"palpate-perception", "model", "def"}}, "abc"),
              Is(Grade::kFailure, "other messages than this build: palpate-perception on model",
                 "same version"));
}

TEST(DoctorNetwork, ClocksOfOtherHostsAgree) {
  EXPECT_THAT(CheckClocks({}, {}), Is(Grade::kOk, "no other host"));
  EXPECT_THAT(CheckClocks({{"model", 0.0004, 0.0002}}, {"model"}),
              Is(Grade::kOk, "model +0.4 ms +- 0.2 ms"));
  EXPECT_THAT(CheckClocks({{"model", -0.310, 0.0002}}, {"model"}),
              Is(Grade::kWarning, "model -310.0 ms", "on model: sudo apt install chrony"));
  // Not known to be large: the link is slow.
  EXPECT_THAT(CheckClocks({{"model", 0.020, 0.030}}, {"model"}), Is(Grade::kOk, "+20.0 ms"));
  EXPECT_THAT(CheckClocks({}, {"model"}),
              Is(Grade::kWarning, "model does not answer", "ping model"));
}

TEST(DoctorChecks, TextHasALineForEachAndColoursForATerminal) {
  const std::vector<Check> checks = {{"disk", Grade::kOk, "fine", ""},
                                     {"camera", Grade::kFailure, "gone", "plug it in"}};
  EXPECT_EQ(ChecksText(checks, false),
            "ok    disk             fine\n"
            "fail  camera           gone; plug it in\n"
            "1 ok, 0 warnings, 1 failed\n");
  EXPECT_THAT(ChecksText(checks, true), HasSubstr("\033[31mfail\033[0m  camera"));
  EXPECT_EQ(Worst(checks), Grade::kFailure);
  EXPECT_EQ(Worst({}), Grade::kOk);
  const auto json = nlohmann::json::parse(ChecksJson(checks));
  EXPECT_EQ(json["grade"], "fail");
  EXPECT_EQ(json["checks"][1]["remedy"], "plug it in");
}

}  // namespace
}  // namespace palpate::command
