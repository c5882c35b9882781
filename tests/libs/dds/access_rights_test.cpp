// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/access_rights.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/dds/node_settings.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::dds {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

security::AccessRights Of(const std::string& role, const std::string& node_namespace = "/",
                          const std::vector<std::string>& remap = {}) {
  const TopicTable table = BuiltInTable();
  return RightsOf(table, role, TopicNames("palpate_" + role, node_namespace, remap, table));
}

TEST(AccessRights, AComponentWritesItsOwnTopicsAlone) {
  EXPECT_THAT(Of("motion_capture").write,
              ElementsAre("ros_discovery_info", "rt/clock_exchange", "rt/component_status",
                          "rt/diagnostics", "rt/perception/markers", "rt/rosout"));
  EXPECT_THAT(Of("motion_capture").read, ElementsAre("rt/clock", "rt/clock_exchange"));
  EXPECT_THAT(Of("force_estimation").write, Contains("rt/forces/*/wrench"));
  EXPECT_THAT(Of("force_estimation").read, Not(Contains(HasSubstr("truth"))));
}

TEST(AccessRights, AnObserverWritesNothingAndAnOperatorGivesCommands) {
  EXPECT_THAT(Of("observer").write, ElementsAre("ros_discovery_info"));
  EXPECT_THAT(Of("observer").read, Contains("rt/*"));
  EXPECT_THAT(Of("view").read, Contains("rt/*"));
  EXPECT_THAT(Of("operator").write, ElementsAre("ros_discovery_info", "rt/calibration/request",
                                                "rt/experiment/load", "rt/experiment/phase"));
}

TEST(AccessRights, OnlyThePlayerWritesWhatOthersDo) {
  EXPECT_THAT(Of("player").write, Contains("rt/forces"));
  EXPECT_THAT(Of("recorder").write, Not(Contains("rt/forces")));
  EXPECT_THAT(Of("perception").write, Not(Contains("rt/forces")));
}

TEST(AccessRights, FollowNamespaceAndRemapping) {
  const auto left = Of("motion_capture", "/left", {"/perception/markers:=/qualisys"}).write;
  EXPECT_THAT(left, Contains("rt/left/component_status"));
  EXPECT_THAT(left, Contains("rt/rosout"));  // global
  EXPECT_THAT(Of("motion_capture", "/", {"/perception/markers:=/qualisys"}).write,
              Contains("rt/qualisys"));
  EXPECT_THAT(Of("force_estimation", "/left").write, Contains("rt/left/forces/*/wrench"));
}

TEST(AccessRights, AnUnknownRoleIsRefused) {
  EXPECT_THAT(test_support::MessageOf([] { Of("perceptoin"); }),
              HasSubstr("did you mean 'perception'?"));
}

TEST(AccessRights, ThereIsAWriterForEachTopic) {
  const TopicTable table = BuiltInTable();
  for (const TopicSettings& topic : table.topics()) {
    EXPECT_FALSE(topic.writers.empty()) << topic.name;
  }
}

/// A variable of the environment as long as this lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

TEST(SecuritySwitch, SettingsThenOurVariablesThenThoseOfRos2) {
  NodeSettings settings;
  EXPECT_FALSE(SecurityOf(settings, "capture").enabled());
  const Variable ros("ROS_SECURITY_KEYSTORE", "/ros");
  EXPECT_FALSE(SecurityOf(settings, "capture").enabled());
  const Variable enable("ROS_SECURITY_ENABLE", "true");
  const Variable enclave("ROS_SECURITY_ENCLAVE_OVERRIDE", "/left_capture");
  EXPECT_EQ(SecurityOf(settings, "capture").keystore, "/ros");
  EXPECT_EQ(SecurityOf(settings, "capture").identity, "left_capture");
  const Variable ours("PALPATE_SECURITY_DIR", "/ours");
  const Variable name("PALPATE_SECURITY_IDENTITY", "right_capture");
  EXPECT_EQ(SecurityOf(settings, "capture").keystore, "/ours");
  EXPECT_EQ(SecurityOf(settings, "capture").identity, "right_capture");
  settings.security = "/set";
  settings.identity = "capture_2";
  EXPECT_EQ(SecurityOf(settings, "capture").keystore, "/set");
  EXPECT_EQ(SecurityOf(settings, "capture").identity, "capture_2");
}

TEST(SecuritySwitch, TheIdentityIsTheComponents) {
  const Variable ours("PALPATE_SECURITY_DIR", "/ours");
  EXPECT_EQ(ParticipantOf({}, "palpate_force_estimation", 0).security.identity, "force_estimation");
}

TEST(SecuritySwitch, SharedMemoryWithSecurityIsRefused) {
  const std::string old = std::getenv("CYCLONEDDS_URI");
  setenv("CYCLONEDDS_URI",
         "<CycloneDDS><Domain><SharedMemory><Enable>true</Enable></SharedMemory></Domain>"
         "</CycloneDDS>",
         1);
  const std::string message = test_support::MessageOf([] {
    Participant({.domain_id = TestDomain(), .node_name = "node", .security = {"/nowhere", "node"}},
                BuiltInTable());
  });
  setenv("CYCLONEDDS_URI", old.c_str(), 1);
  EXPECT_THAT(message, HasSubstr("CYCLONEDDS_URI:1: shared memory passes by DDS Security"));
}

TEST(SecuritySwitch, DomainsThatCannotBeSecuredAreRefused) {
  EXPECT_THAT(test_support::MessageOf([] {
                Participant({.domain_id = 231, .node_name = "node", .security = {"/nowhere", "n"}},
                            BuiltInTable());
              }),
              HasSubstr("domain 231 cannot be secured: take one up to 230"));
}

TEST(SecuritySwitch, AMissingKeystoreStopsTheStart) {
  const std::string message = test_support::MessageOf([] {
    Participant({.domain_id = TestDomain(), .node_name = "node", .security = {"/nowhere", "node"}},
                BuiltInTable());
  });
  EXPECT_THAT(message, HasSubstr("/nowhere/enclaves/node: no identity 'node' here"));
}

}  // namespace
}  // namespace palpate::dds
