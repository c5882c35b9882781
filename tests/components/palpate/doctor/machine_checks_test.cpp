// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/machine_checks.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "components/palpate/doctor/machine_facts.hpp"
#include "components/palpate/doctor/system_facts.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/doctor/check_matcher.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kDay_s = 86400.0;

TEST(DoctorMachine, TheProcessorHasFastKernelsAndTwoThreads) {
  ProcessorFacts facts{.best = InstructionSet::kAvx2,
                       .threads = 8,
                       .blas_core = {},
                       .governor = "performance",
                       .thread_limit = {}};
  EXPECT_THAT(CheckProcessor(facts), Is(Grade::kOk, "8 threads"));
  facts.governor = "powersave";
  EXPECT_THAT(CheckProcessor(facts), Is(Grade::kWarning, "clock governor powersave", "cpupower"));
  facts.thread_limit = "1";
  EXPECT_THAT(CheckProcessor(facts), Is(Grade::kWarning, "OMP_NUM_THREADS=1", "unset"));
  facts.threads = 1;
  EXPECT_THAT(CheckProcessor(facts), Is(Grade::kWarning, "share one core", "two cores"));
  facts.best = InstructionSet::kPortable;
  EXPECT_THAT(CheckProcessor(facts), Is(Grade::kWarning, "no AVX2", "AVX2"));
}

TEST(DoctorMachine, TheDiskHasRoomForRecordings) {
  EXPECT_THAT(CheckDisk({"/data", 100'000'000'000}),
              Is(Grade::kOk, "100.0 GB free in /data: 27 min"));
  EXPECT_THAT(CheckDisk({"/data", 5'000'000'000}), Is(Grade::kWarning, "5.0 GB", "--out FOLDER"));
  EXPECT_THAT(CheckDisk({"/data", 500'000'000}), Is(Grade::kFailure, "0.5 GB", "--out FOLDER"));
  EXPECT_THAT(CheckDisk({"/data", std::nullopt}), Is(Grade::kWarning, "cannot be read"));
}

SecurityFacts Secured() {
  return {.is_on = true,
          .folder = "keys",
          .folder_exists = true,
          .certificates = {{"keys/ca.pem", 900 * kDay_s}, {"keys/capture/cert.pem", 90.5 * kDay_s}},
          .open_keys = {}};
}

TEST(DoctorMachine, SecurityFilesAreValidAndPrivate) {
  EXPECT_THAT(CheckSecurity({}), Is(Grade::kOk, "off: any process"));
  EXPECT_THAT(CheckSecurity({.is_on = true, .folder = {}, .certificates = {}, .open_keys = {}}),
              Is(Grade::kWarning, "not checked", "--security FOLDER"));
  EXPECT_THAT(CheckSecurity(Secured()),
              Is(Grade::kOk, "2 certificates in keys, the first expires in 90 days (cert.pem)"));
  SecurityFacts facts = Secured();
  facts.certificates[1].valid_for_s = 10 * kDay_s;
  EXPECT_THAT(CheckSecurity(facts), Is(Grade::kWarning, "10 days", "palpate security"));
  facts.certificates[1].valid_for_s = -3 * kDay_s;
  EXPECT_THAT(CheckSecurity(facts), Is(Grade::kFailure, "cert.pem expired 3 days ago", "security"));
  facts.certificates[1].valid_for_s = std::nullopt;
  EXPECT_THAT(CheckSecurity(facts), Is(Grade::kFailure, "cert.pem cannot be read", "security"));
  facts.open_keys = {"keys/capture/key.pem"};
  EXPECT_THAT(CheckSecurity(facts),
              Is(Grade::kFailure, "other users can read", "chmod 600 keys/capture/key.pem"));
  facts.certificates.clear();
  EXPECT_THAT(CheckSecurity(facts), Is(Grade::kFailure, "no certificate", "security"));
  facts.folder_exists = false;
  EXPECT_THAT(CheckSecurity(facts), Is(Grade::kFailure, "keys is not there", "security"));
}

TEST(DoctorMachine, CamerasAnswerOverLargePackets) {
  const CameraFacts camera{"Acme ToF", "192.0.2.9", 9000, "eth0", {}};
  EXPECT_THAT(CheckCameras({}, false), Is(Grade::kOk, "no GenICam camera answers"));
  EXPECT_THAT(CheckCameras({}, true), Is(Grade::kFailure, "no GenICam", "palpate capture --list"));
  EXPECT_THAT(CheckCameras({camera}, true),
              Is(Grade::kOk, "Acme ToF at 192.0.2.9, packets up to 9000 B on eth0"));
  CameraFacts slow = camera;
  slow.mtu_B = 1500;
  EXPECT_THAT(CheckCameras({slow}, true),
              Is(Grade::kWarning, "1500 B", "sudo ip link set dev eth0 mtu 9000"));
  CameraFacts busy = camera;
  busy.trouble = "another program controls it";
  EXPECT_THAT(CheckCameras({busy}, true), Is(Grade::kWarning, "(another program controls it)"));
}

TEST(DoctorMachine, RobotAndCalibrationFileFit) {
  EXPECT_THAT(CheckRobotFiles("beam", "", Status::Ok()), Is(Grade::kOk, "beam can be read"));
  EXPECT_THAT(CheckRobotFiles("beam", "c.yaml", Status::Ok()),
              Is(Grade::kOk, "beam and c.yaml fit"));
  EXPECT_THAT(CheckRobotFiles("beam", "c.yaml", {StatusCode::kInvalidInput, "another mesh"}),
              Is(Grade::kFailure, "another mesh", "palpate calibrate beam --data"));
  EXPECT_FALSE(CompareRobotFiles("no_such_robot", {}).ok());
  EXPECT_TRUE(CompareRobotFiles("rod", {}).ok());
}

TEST(DoctorFacts, ReadsCertificatesAndFindsOpenKeys) {
  const test_support::TestFolder folder;
  const std::string make =
      "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 20 -subj "
      "/CN=a -keyout " +
      (folder.path() / "key.pem").string() + " -out " + (folder.path() / "cert.pem").string() +
      " 2>/dev/null";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "openssl is not installed";
  std::filesystem::permissions(folder.path() / "key.pem", std::filesystem::perms(0644));
  const SecurityFacts facts = ReadSecurity(folder.path(), true);
  ASSERT_EQ(facts.certificates.size(), 1U);
  ASSERT_TRUE(facts.certificates[0].valid_for_s);
  EXPECT_NEAR(*facts.certificates[0].valid_for_s / kDay_s, 20.0, 0.1);
  EXPECT_THAT(facts.open_keys, ElementsAre(folder.path() / "key.pem"));
  WriteFile(folder.path() / "cert.pem", "-----BEGIN CERTIFICATE-----\nbroken\n");
  EXPECT_FALSE(ReadSecurity(folder.path(), true).certificates[0].valid_for_s);
}

TEST(DoctorFacts, ThereIsARouteToOneself) {
  EXPECT_EQ(LocalAddressTo("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(LocalAddressTo("no.such.host.invalid"), "");
  EXPECT_FALSE(MulticastComesBack("no address", std::chrono::milliseconds(1)));
}

constexpr char kSystem[] = R"(
name: lab
domain: 7
transport: lossy_link
security: keys
hosts:
  - name: camera
    address: 192.0.2.1
    interface: eth1
    processes:
      - {name: c, component: capture}
  - name: model
    address: 192.0.2.2
    processes:
      - {name: f, component: force_estimation, arguments: [rod, --calibration, $(cal)]}
)";

SystemFacts Facts(const std::string& host, const std::vector<std::string>& own_names = {}) {
  return ReadSystemFacts(app::ParseYaml(kSystem, "/etc/lab.yaml"), host, own_names);
}

TEST(DoctorFacts, ASystemFileSaysWhatThisHostNeeds) {
  const SystemFacts camera = Facts("", {"192.0.2.1"});
  EXPECT_EQ(camera.domain_id, 7);
  EXPECT_EQ(camera.transport, "lossy_link");
  EXPECT_EQ(camera.network_interface, "eth1");
  EXPECT_EQ(camera.security, "/etc/keys");
  EXPECT_THAT(camera.peers, ElementsAre("192.0.2.2"));
  EXPECT_TRUE(camera.has_genicam_camera);
  EXPECT_TRUE(camera.robot.empty());
  std::string with_virtual = kSystem;
  const std::string capture = "{name: c, component: capture}";
  with_virtual.insert(with_virtual.find(capture) + capture.size(),
                      "\n      - {name: v, component: virtual_camera}");
  EXPECT_FALSE(
      ReadSystemFacts(app::ParseYaml(with_virtual, "a.yaml"), "camera", {}).has_genicam_camera);
  const SystemFacts model = Facts("model");
  EXPECT_FALSE(model.has_genicam_camera);
  EXPECT_EQ(model.robot, "rod");
  EXPECT_TRUE(model.calibration.empty());
}

std::string RefusalOfHost(const std::string& host) {
  try {
    Facts(host);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DoctorFacts, RefusesASystemFileOfOtherHosts) {
  EXPECT_THAT(RefusalOfHost("modell"), HasSubstr("has no host 'modell' (did you mean 'model'?)"));
  EXPECT_THAT(RefusalOfHost(""), HasSubstr("give --host, one of camera, model"));
}

}  // namespace
}  // namespace palpate::command
