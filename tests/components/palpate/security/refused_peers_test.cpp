// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "libs/core/error.hpp"
#include "tests/components/palpate/security/secured_domain.hpp"

namespace palpate::command {
namespace {

using std::filesystem::path;
using testing::HasSubstr;

/// So many messages of the control arrive while those of the refused one could, too.
constexpr int kEnough = 20;

class RefusedPeers : public testing::Test {
 protected:
  dds::SecuritySettings As(const std::string& identity) const { return {keystore_, identity}; }

  test_support::TestFolder folder_;
  SeparateDomains domains_;
  path keystore_ = MakeKeystore(folder_, "keystore");
  DdsReports reports_;
};

TEST_F(RefusedPeers, AnEnrolledPairCommunicates) {
  ForceSender sender("ours", As("force_estimation"));
  ForceReceiver receiver("observer", As("observer"));
  EXPECT_TRUE(
      receiver.ReceiveUntil({&sender}, [&] { return receiver.CountOf("ours") >= kEnough; }));
  EXPECT_FALSE(reports_.Has("not valid")) << reports_.Text();
}

TEST_F(RefusedPeers, APlainReaderGetsNothing) {
  ForceSender ours("ours", As("force_estimation"));
  ForceReceiver observer("observer", As("observer"));
  ForceSender plain_sender("plain");
  ForceReceiver plain("plain_reader");
  EXPECT_TRUE(plain.ReceiveUntil({&ours, &plain_sender}, [&] {
    observer.Dispatch();
    return plain.CountOf("plain") >= kEnough && observer.CountOf("ours") >= kEnough;
  }));
  EXPECT_EQ(plain.CountOf("ours"), 0);
  EXPECT_EQ(plain.matched(), 1u);
  EXPECT_EQ(ours.matched(), 1u);
}

TEST_F(RefusedPeers, APlainWriterIsNotHeard) {
  ForceSender ours("ours", As("force_estimation"));
  ForceSender plain("plain");
  ForceReceiver plain_reader("plain_reader");
  ForceReceiver observer("observer", As("observer"));
  EXPECT_TRUE(observer.ReceiveUntil({&ours, &plain}, [&] {
    plain_reader.Dispatch();
    return observer.CountOf("ours") >= kEnough && plain_reader.CountOf("plain") >= kEnough;
  }));
  EXPECT_EQ(observer.CountOf("plain"), 0);
  EXPECT_EQ(observer.matched(), 1u);
}

TEST_F(RefusedPeers, AnIdentityOfAnotherAuthorityIsRefused) {
  const path foreign = MakeKeystore(folder_, "foreign");
  ForceSender ours("ours", As("force_estimation"));
  ForceReceiver observer("observer", As("observer"));
  ForceSender theirs("theirs", {foreign, "force_estimation"});
  ForceReceiver their_observer("their_observer", {foreign, "observer"});
  EXPECT_TRUE(observer.ReceiveUntil({&ours, &theirs}, [&] {
    their_observer.Dispatch();
    return observer.CountOf("ours") >= kEnough && their_observer.CountOf("theirs") >= kEnough;
  }));
  EXPECT_EQ(observer.CountOf("theirs"), 0);
  EXPECT_EQ(their_observer.CountOf("ours"), 0);
  EXPECT_THAT(reports_.Text(), HasSubstr("unable to get local issuer certificate; subject: "
                                         "/CN=force_estimation"));
}

TEST_F(RefusedPeers, AnIdentityWithoutThePermissionCannotWrite) {
  NetworkNode perception("perception", As("perception"));
  const std::string message = test_support::MessageOf<RunError>(
      [&] { perception.participant.CreateWriter(dds::kForcesTopic); });
  EXPECT_THAT(message, HasSubstr("/forces"));
  EXPECT_THAT(message, HasSubstr("the permissions of this identity lack it"));
  perception.participant.CreateWriter(dds::kRobotCloudTopic);
}

TEST_F(RefusedPeers, PermissionsOfAnotherAuthorityAreRefusedByTheOthers) {
  // An enrolled identity whose files have permissions that somebody else signed.
  const path foreign = MakeKeystore(folder_, "foreign");
  for (const char* file : {"permissions_ca.cert.pem", "governance.p7s", "permissions.p7s"}) {
    std::filesystem::copy_file(foreign / "enclaves/player" / file,
                               keystore_ / "enclaves/player" / file,
                               std::filesystem::copy_options::overwrite_existing);
  }
  ForceSender ours("ours", As("force_estimation"));
  ForceReceiver observer("observer", As("observer"));
  ForceSender forged("forged", As("player"));
  EXPECT_TRUE(
      observer.ReceiveUntil({&ours, &forged}, [&] { return observer.CountOf("ours") >= kEnough; }));
  const std::string refusal = "permissions from plugin: Failed to parse PKCS7 SMIME document";
  EXPECT_TRUE(observer.ReceiveUntil({&ours, &forged}, [&] {
    return observer.CountOf("ours") >= kEnough && reports_.Has(refusal);
  })) << reports_.Text();
  EXPECT_EQ(observer.CountOf("forged"), 0);
}

TEST_F(RefusedPeers, TamperedPermissionsStopTheStart) {
  const path file = keystore_ / "enclaves/perception/permissions.p7s";
  std::string permissions = ReadFile(file);
  permissions.replace(permissions.find("rt/perception/contacts"), 22, "rt/forces             ");
  WriteFile(file, permissions);
  const std::string message =
      test_support::MessageOf([&] { NetworkNode("perception", As("perception")); });
  EXPECT_THAT(message, HasSubstr(file.string() + ": was changed after it was signed"));
}

TEST_F(RefusedPeers, ARevokedIdentityIsRefusedByTheOthers) {
  const path stolen = folder_ / "stolen";
  std::filesystem::copy(keystore_, stolen, std::filesystem::copy_options::recursive);
  SecurityOptions revoke;
  revoke.action = "revoke";
  revoke.keystore = keystore_;
  revoke.names = {"player"};
  ASSERT_EQ(RunSecurity(revoke), 0);

  ForceSender ours("ours", As("force_estimation"));
  ForceReceiver observer("observer", As("observer"));
  ForceSender revoked("revoked", {stolen, "player"});
  ForceReceiver old_observer("old_observer", {stolen, "observer"});
  EXPECT_TRUE(observer.ReceiveUntil({&ours, &revoked}, [&] {
    old_observer.Dispatch();
    return observer.CountOf("ours") >= kEnough && old_observer.CountOf("revoked") >= kEnough;
  }));
  EXPECT_EQ(observer.CountOf("revoked"), 0);
  EXPECT_THAT(reports_.Text(), HasSubstr("certificate revoked; subject: /CN=player"));
  EXPECT_THAT(test_support::MessageOf([&] { NetworkNode("player", As("player")); }),
              HasSubstr("no identity 'player' here"));
}

TEST_F(RefusedPeers, ARevokedIdentityThatHasTheListDoesNotStart) {
  const path old = folder_ / "old";
  std::filesystem::copy(keystore_ / "enclaves/player", old);
  SecurityOptions revoke;
  revoke.action = "revoke";
  revoke.keystore = keystore_;
  revoke.names = {"player"};
  ASSERT_EQ(RunSecurity(revoke), 0);
  std::filesystem::copy(old, keystore_ / "enclaves/player");
  std::filesystem::copy_file(keystore_ / "public/crl.pem", keystore_ / "enclaves/player/crl.pem",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(test_support::MessageOf([&] { NetworkNode("player", As("player")); }),
              HasSubstr("cert.pem: was revoked"));
}

}  // namespace
}  // namespace palpate::command
