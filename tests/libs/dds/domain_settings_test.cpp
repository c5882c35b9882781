// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/domain_settings.hpp"

#include <gmock/gmock.h>

#include <map>
#include <string>

namespace palpate::dds {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

const std::string kFolder = "file://" PALPATE_SOURCE_DIR "/config/cyclonedds/";

Environment Variables(const std::map<std::string, std::string>& variables) {
  return [variables](const std::string& name) -> std::optional<std::string> {
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional(found->second);
  };
}

NetworkInterface Loopback() {
  return {.name = "lo",
          .addresses = {"127.0.0.1"},
          .is_up = true,
          .is_loopback = true,
          .has_multicast = false,
          .mtu_B = 65536};
}

NetworkInterface Ethernet(bool is_up = true) {
  return {.name = "eth0",
          .addresses = {"192.0.2.7"},
          .is_up = is_up,
          .is_loopback = false,
          .has_multicast = true,
          .mtu_B = 1500};
}

DomainSettings Read(const std::string& uri,
                    const std::map<std::string, std::string>& variables = {}) {
  return ReadDomainSettings(uri, 7, Variables(variables));
}

std::string General(const std::string& inside) {
  return "<CycloneDDS><Domain id=\"any\"><General>" + inside + "</General></Domain></CycloneDDS>";
}

std::string RefusalWithBoth(const std::string& uri) {
  return RefusalOf(Read(uri), {Loopback(), Ethernet()});
}

TEST(DomainSettings, VariablesAreReplacedAsCycloneDoes) {
  const Environment environment = Variables({{"A", "x"}, {"EMPTY", ""}});
  EXPECT_EQ(ExpandVariables("1${A}2", environment), "1x2");
  EXPECT_EQ(ExpandVariables("${B}", environment), "");
  EXPECT_EQ(ExpandVariables("${B:-d}${EMPTY:-e}${A:-f}", environment), "dex");
  EXPECT_EQ(ExpandVariables("${A:+y}${B:+z}", environment), "y");
  EXPECT_EQ(ExpandVariables("${B:-${A}}", environment), "x");
  EXPECT_EQ(ExpandVariables("${A", environment), "${A");
}

TEST(DomainSettings, ReadsThoseThatWeShip) {
  const DomainSettings lan = Read(kFolder + "lan.xml");
  EXPECT_TRUE(lan.interfaces.empty());
  EXPECT_EQ(lan.max_message_B, 1400);
  EXPECT_TRUE(lan.UsesMulticast());
  EXPECT_EQ(lan.max_participant_index, 60);
  EXPECT_EQ(Read(kFolder + "jumbo_lan.xml").max_message_B, 8900);
  const DomainSettings lossy =
      Read(kFolder + "lossy_link.xml", {{"PALPATE_PEERS", "10.0.0.1, 10.0.0.2"}});
  EXPECT_FALSE(lossy.UsesMulticast());
  EXPECT_THAT(lossy.peers, ElementsAre("127.0.0.1", "10.0.0.1", "10.0.0.2"));
}

TEST(DomainSettings, LaterPartsWinAndOtherDomainsDoNotCount) {
  EXPECT_EQ(
      Read(kFolder + "lan.xml," + General("<MaxMessageSize>9 kB</MaxMessageSize>")).max_message_B,
      9 * 1024);
  const std::string other =
      "<CycloneDDS><Domain Id=\"8\"><General><MaxMessageSize>9B"
      "</MaxMessageSize></General></Domain></CycloneDDS>";
  EXPECT_FALSE(Read(other).max_message_B.has_value());
}

TEST(DomainSettings, InterfacesOfAllPartsCount) {
  const std::string part = "<Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"";
  const std::string end = "\"/></Interfaces></General></Domain>";
  const DomainSettings settings = Read(kFolder + "lan.xml," + part + "eth1" + end);
  ASSERT_EQ(settings.interfaces.size(), 1U);
  EXPECT_EQ(settings.interfaces[0].name, "eth1");
  EXPECT_EQ(Read(part + "${X:-a}" + end + "," + part + "b" + end).interfaces.size(), 2U);
}

TEST(DomainSettings, WhatCycloneRefusesIsLeftToIt) {
  EXPECT_THAT(Read("file:///no/such/file.xml").missing_files, ElementsAre("/no/such/file.xml"));
  EXPECT_TRUE(Read("file:///no/such/file.xml").interfaces.empty());
  EXPECT_TRUE(Read("<CycloneDDS><").interfaces.empty());
}

TEST(DomainSettings, NoneThatWeShipIsRefused) {
  for (const char* name : {"default", "one_host", "lan", "jumbo_lan", "lossy_link"}) {
    EXPECT_EQ(RefusalWithBoth(kFolder + name + ".xml"), "") << name;
  }
  EXPECT_EQ(RefusalWithBoth("file://" PALPATE_SOURCE_DIR "/tests/system/loopback.xml"), "");
}

TEST(DomainSettings, LargeDatagramsMustNotLeaveTheHost) {
  const std::string large = "<MaxMessageSize>65500B</MaxMessageSize>";
  EXPECT_THAT(RefusalWithBoth(General(large)),
              MatchesRegex("CYCLONEDDS_URI:1: MaxMessageSize 65500 B is for loopback alone.*"));
  const auto with = [&](const std::string& interface) {
    return RefusalWithBoth(
        General("<Interfaces><NetworkInterface " + interface + "/></Interfaces>" + large));
  };
  EXPECT_THAT(with("name=\"eth0\""), HasSubstr("lan.xml"));
  EXPECT_THAT(with("address=\"192.0.2.7\""), HasSubstr("65500"));
  EXPECT_THAT(with("autodetermine=\"true\""), HasSubstr("65500"));
  EXPECT_EQ(with("name=\"lo\""), "");
  EXPECT_EQ(with("address=\"127.0.0.1\""), "");
  EXPECT_EQ(RefusalOf(Read(General(large)), {Loopback(), Ethernet(false)}), "");
}

TEST(DomainSettings, SharedMemoryPassesBySecurity) {
  const std::string shared = "<SharedMemory><Enable>true</Enable></SharedMemory>";
  const std::string security = "\n<Security><Authentication/></Security>";
  const auto of = [](const std::string& inside) {
    return RefusalWithBoth("<CycloneDDS><Domain>" + inside + "</Domain></CycloneDDS>");
  };
  EXPECT_THAT(of(shared + security),
              MatchesRegex("CYCLONEDDS_URI:1: shared memory .*CYCLONEDDS_URI:2.*"));
  EXPECT_EQ(of(shared), "");
  EXPECT_EQ(of(security), "");
  EXPECT_EQ(of("<SharedMemory><Enable>false</Enable></SharedMemory>" + security), "");
  const DomainSettings by_ros = Read(shared, {{"ROS_SECURITY_ENABLE", "true"}});
  EXPECT_THAT(RefusalOf(by_ros, {Loopback()}), HasSubstr("(ROS_SECURITY_ENABLE)"));
}

}  // namespace
}  // namespace palpate::dds
