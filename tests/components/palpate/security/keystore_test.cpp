// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "components/palpate/node/verbs.hpp"
#include "components/palpate/security/wanted_identities.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using std::filesystem::path;
using test_support::MessageOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Answer {
  int code = 0;
  std::string text;
};

Answer RunVerb(std::vector<std::string> words) {
  words.insert(words.begin(), "security");
  testing::internal::CaptureStdout();
  int code = 0;
  try {
    code = RunCommand(words);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  return {code, testing::internal::GetCapturedStdout()};
}

constexpr char kSystem[] = R"(
name: two_hosts
hosts:
  - name: camera_host
    processes:
      - {name: eye, component: capture, set: {dds.identity: left_capture}, remap: ["/camera/setup:=/left/setup"]}
      - {name: driver, program: some_driver}
  - name: model_host
    processes:
      - {name: model, component: force_estimation}
      - {name: perception, component: perception}
)";

class KeystoreTest : public testing::Test {
 protected:
  std::string keystore() const { return folder_ / "keystore"; }
  path Enclave(const std::string& name) const { return folder_ / ("keystore/enclaves/" + name); }
  std::string Host(const std::string& name) const { return folder_ / name; }
  /// What a person copies to a host.
  void CopyTo(const std::string& host, const std::vector<std::string>& names) const {
    std::filesystem::remove_all(Host(host));
    for (const std::string& name : names) {
      std::filesystem::create_directories(path(Host(host)) / "enclaves");
      std::filesystem::copy(Enclave(name), path(Host(host)) / "enclaves" / name);
    }
  }
  void InitTwoHosts() {
    folder_.Write("system.yaml", kSystem);
    ASSERT_EQ(RunVerb({"init", keystore(), "--system", folder_ / "system.yaml"}).code, 0);
  }

  test_support::TestFolder folder_;
};

TEST_F(KeystoreTest, InitWithoutNamesEnrollsAllComponentsAndCommands) {
  const Answer init = RunVerb({"init", keystore()});
  EXPECT_EQ(init.code, 0);
  EXPECT_THAT(init.text, HasSubstr("two authorities and 12 identities"));
  const Answer check = RunVerb({"check", keystore(), "--json"});
  EXPECT_EQ(check.code, 0) << check.text;
  const auto json = nlohmann::json::parse(check.text);
  std::vector<std::string> names;
  for (const auto& identity : json.at("identities")) names.push_back(identity.at("name"));
  EXPECT_THAT(names, ElementsAre("calibration", "capture", "force_estimation", "motion_capture",
                                 "observer", "operator", "perception", "player", "recorder", "view",
                                 "virtual_camera", "virtual_robot"));
}

TEST_F(KeystoreTest, PrivateKeysAreTheOwnersAlone) {
  ASSERT_EQ(RunVerb({"init", keystore(), "capture"}).code, 0);
  for (const path& file :
       {Enclave("capture") / "key.pem", path(keystore()) / "private/identity_ca.key.pem",
        path(keystore()) / "private/permissions_ca.key.pem"}) {
    struct stat status {};
    ASSERT_EQ(stat(file.c_str(), &status), 0) << file;
    EXPECT_EQ(status.st_mode & 07777u, 0600u) << file;
  }
}

TEST_F(KeystoreTest, InitRefusesAFolderThatIsThere) {
  folder_.Write("keystore/file", "");
  EXPECT_THAT(MessageOf([&] { RunVerb({"init", keystore()}); }), HasSubstr("is there already"));
}

TEST_F(KeystoreTest, NothingIsMadeForAnUnknownRole) {
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"init", keystore(), "captur"});
              }),
              HasSubstr("did you mean 'capture'?"));
  EXPECT_FALSE(std::filesystem::exists(keystore()));
}

TEST_F(KeystoreTest, ASystemFileSaysWhoIsOnWhichHost) {
  InitTwoHosts();
  const auto json = nlohmann::json::parse(RunVerb({"check", keystore(), "--json"}).text);
  const auto& identities = json.at("identities");
  ASSERT_EQ(identities.size(), 5u);
  EXPECT_EQ(identities.at(1).at("name"), "left_capture");
  EXPECT_EQ(identities.at(1).at("role"), "capture");
  EXPECT_EQ(identities.at(1).at("host"), "camera_host");
  EXPECT_THAT(json.at("outdated_hosts"), ElementsAre("camera_host", "model_host"));
  const std::string permissions = ReadFile(Enclave("left_capture") / "permissions.p7s");
  EXPECT_THAT(permissions, HasSubstr("rt/left/setup"));
  EXPECT_THAT(permissions, Not(HasSubstr("rt/camera/setup")));
  EXPECT_EQ(RunVerb({"check", keystore(), "--system", folder_ / "system.yaml"}).code, 0);
}

TEST_F(KeystoreTest, TwoProcessesOfOneIdentityAreRefused) {
  const std::string file =
      folder_.Write("system.yaml",
                    "name: s\n"
                    "hosts: [{name: a, processes: [{name: one, component: capture}]},\n"
                    "        {name: b, processes: [{name: two, component: capture}]}]\n");
  EXPECT_THAT(MessageOf([&] { IdentitiesOfSystem(ReadSystemFile(file, app::LoadYaml)); }),
              AllOf(HasSubstr("system.yaml:3:"),
                    HasSubstr("'two' is a second process with the identity 'capture'")));
}

TEST_F(KeystoreTest, CheckFindsWhatTheSystemFileHasAndTheKeystoreLacks) {
  InitTwoHosts();
  folder_.Write("grown.yaml", std::string(kSystem) + "      - {name: c, component: calibration}\n");
  const Answer check = RunVerb({"check", keystore(), "--system", folder_ / "grown.yaml"});
  EXPECT_EQ(check.code, 1);
  EXPECT_THAT(check.text, HasSubstr("enclaves/calibration: is not enrolled"));
}

TEST_F(KeystoreTest, RevokeSaysWhichHostsHaveTheOldFiles) {
  InitTwoHosts();
  CopyTo("camera", {"left_capture"});
  CopyTo("model", {"force_estimation", "perception"});
  const Answer good = RunVerb({"check", keystore(), "--host", "camera_host=" + Host("camera"),
                               "--host", "model_host=" + Host("model")});
  EXPECT_EQ(good.code, 0) << good.text;
  EXPECT_THAT(good.text, Not(HasSubstr("hosts not seen")));

  const Answer revoked = RunVerb({"revoke", keystore(), "perception"});
  EXPECT_EQ(revoked.code, 0);
  EXPECT_THAT(revoked.text, HasSubstr("hosts that still have the old files"));
  EXPECT_THAT(revoked.text, HasSubstr("camera_host: copy enclaves/ of left_capture"));
  EXPECT_FALSE(std::filesystem::exists(Enclave("perception")));

  CopyTo("camera", {"left_capture"});
  const Answer half = RunVerb({"check", keystore(), "--host", "camera_host=" + Host("camera"),
                               "--host", "model_host=" + Host("model")});
  EXPECT_EQ(half.code, 1);
  EXPECT_THAT(half.text, HasSubstr("hosts not seen with the files of now: model_host"));
  EXPECT_THAT(half.text, HasSubstr("enclaves/perception: was revoked"));
  EXPECT_THAT(half.text, HasSubstr("force_estimation/crl.pem: is not that of the keystore"));
  EXPECT_THAT(half.text, HasSubstr("revoked: perception"));
}

TEST_F(KeystoreTest, AHostChecksItsOwnFiles) {
  InitTwoHosts();
  CopyTo("camera", {"left_capture"});
  EXPECT_EQ(RunVerb({"check", Host("camera")}).code, 0);
  chmod((Host("camera") + "/enclaves/left_capture/key.pem").c_str(), 0644);
  const Answer open = RunVerb({"check", Host("camera")});
  EXPECT_EQ(open.code, 1);
  EXPECT_THAT(open.text, HasSubstr("other users may read it"));
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"check", Host("camera"), "--host", "a=b"});
              }),
              HasSubstr("is no keystore"));
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"check", Host("nowhere")});
              }),
              HasSubstr("has no identities"));
}

TEST_F(KeystoreTest, TheKeysOfAuthoritiesAreNotForHosts) {
  InitTwoHosts();
  std::filesystem::copy(keystore(), Host("camera"), std::filesystem::copy_options::recursive);
  const Answer check = RunVerb({"check", keystore(), "--host", "camera_host=" + Host("camera")});
  EXPECT_EQ(check.code, 1);
  EXPECT_THAT(check.text, HasSubstr("keys of the authorities are on host camera_host"));
  EXPECT_THAT(check.text, HasSubstr("enclaves/perception: belongs to another host"));
}

TEST_F(KeystoreTest, EnrollRenewsWhatIsThere) {
  InitTwoHosts();
  const std::string before = ReadFile(Enclave("left_capture") / "cert.pem");
  ASSERT_EQ(RunVerb({"enroll", keystore(), "left_capture", "--days", "10"}).code, 0);
  EXPECT_NE(ReadFile(Enclave("left_capture") / "cert.pem"), before);
  const Answer check = RunVerb({"check", keystore(), "left_capture"});
  EXPECT_EQ(check.code, 0) << check.text;
  EXPECT_THAT(check.text, HasSubstr("left_capture (capture) on camera_host: valid to"));
  EXPECT_THAT(check.text, HasSubstr("warning: "));
}

TEST_F(KeystoreTest, AnIdentityThatMovesLeavesOldFilesOnItsFormerHost) {
  ASSERT_EQ(RunVerb({"init", keystore(), "capture@old_host"}).code, 0);
  CopyTo("old", {"capture"});
  ASSERT_EQ(RunVerb({"check", keystore(), "--host", "old_host=" + Host("old")}).code, 0);
  const Answer moved = RunVerb({"enroll", keystore(), "capture=capture@new_host"});
  EXPECT_THAT(moved.text, HasSubstr("old_host: remove all of enclaves/"));
  EXPECT_THAT(moved.text, HasSubstr("new_host: copy enclaves/ of capture"));
}

TEST_F(KeystoreTest, AnEnrolledNameAfterARevocationIsGoodAgain) {
  ASSERT_EQ(RunVerb({"init", keystore(), "capture"}).code, 0);
  ASSERT_EQ(RunVerb({"revoke", keystore(), "capture"}).code, 0);
  ASSERT_EQ(RunVerb({"enroll", keystore(), "capture"}).code, 0);
  EXPECT_EQ(RunVerb({"check", keystore()}).code, 0);
}

TEST_F(KeystoreTest, PermissionsThatAreNotThoseOfTheTableAreFound) {
  ASSERT_EQ(RunVerb({"init", keystore(), "capture"}).code, 0);
  // The manifest is changed, as a table of topics changes between two versions.
  std::string manifest = ReadFile(path(keystore()) / "manifest.json");
  manifest.replace(manifest.find("\"role\": \"capture\""), 17, "\"role\": \"recorder\"");
  WriteFile(path(keystore()) / "manifest.json", manifest);
  const Answer check = RunVerb({"check", keystore()});
  EXPECT_EQ(check.code, 1);
  EXPECT_THAT(check.text, HasSubstr("for writing has rt/camera/color/camera_info"));
  EXPECT_THAT(
      check.text,
      HasSubstr("for reading has rt/clock, rt/clock_exchange, lacks ros_discovery_info, rt/*"));
}

TEST_F(KeystoreTest, WrongUsageIsRefused) {
  EXPECT_THAT(MessageOf([&] { RunVerb({"inti", keystore()}); }), HasSubstr("did you mean 'init'?"));
  EXPECT_THAT(MessageOf([&] { RunVerb({"check", keystore()}); }), HasSubstr("has no identities"));
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"revoke", keystore(), "a"});
              }),
              HasSubstr("is no keystore"));
  ASSERT_EQ(RunVerb({"init", keystore(), "capture"}).code, 0);
  EXPECT_THAT(MessageOf([&] { RunVerb({"revoke", keystore()}); }), HasSubstr("revoke needs NAME"));
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"revoke", keystore(), "captur"});
              }),
              HasSubstr("did you mean 'capture'?"));
  EXPECT_THAT(MessageOf([&] { RunVerb({"enroll", keystore()}); }), HasSubstr("enroll needs NAME"));
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"enroll", keystore(), "a/b=capture"});
              }),
              HasSubstr("no name of an identity"));
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"enroll", keystore(), "capture", "--host", "a=b"});
              }),
              HasSubstr("--host is for check"));
  EXPECT_THAT(MessageOf([&] {
                RunVerb({"check", keystore(), "--host", "a"});
              }),
              HasSubstr("must be HOST=PATH"));
}

}  // namespace
}  // namespace palpate::command
