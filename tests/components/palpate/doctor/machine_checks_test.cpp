// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/machine_checks.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "components/palpate/doctor/machine_facts.hpp"
#include "components/palpate/doctor/system_facts.hpp"
#include "libs/app/yaml.hpp"
#include "tests/components/palpate/doctor/check_matcher.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

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

/// A keystore of two identities, at a day.
SecurityFacts Secured() {
  constexpr std::int64_t kNow_s = 1'800'000'000;
  const auto end_s = [](double days) { return kNow_s + static_cast<std::int64_t>(days * kDay_s); };
  SecurityFacts facts{.is_on = true, .folder = "keys", .trouble = {}, .state = {}, .now_s = kNow_s};
  for (const auto& [name, days] : {std::pair("capture", 90.5), std::pair("observer", 900.0)}) {
    IdentityState& identity = facts.state.identities.emplace_back();
    identity.name = name;
    identity.end_s = end_s(days);
  }
  return facts;
}

TEST(DoctorMachine, SecurityFilesAreJudgedAsTheKeystoresCheckDoes) {
  EXPECT_THAT(CheckSecurity({}), Is(Grade::kOk, "off: any process"));
  EXPECT_THAT(CheckSecurity({.is_on = true, .folder = {}, .trouble = {}, .state = {}}),
              Is(Grade::kWarning, "not checked", "--security FOLDER"));
  EXPECT_THAT(CheckSecurity(Secured()),
              Is(Grade::kOk, "2 identities in keys, the first one, capture, ends in 90 days"));
  SecurityFacts facts = Secured();
  facts.state.identities[1].findings = {
      {Severity::kWarning, "keys/cert.pem", "ends in 10 days", "palpate security enroll"}};
  EXPECT_THAT(CheckSecurity(facts),
              Is(Grade::kWarning, "keys/cert.pem ends in 10 days", "palpate security enroll"));
  facts.state.identities[1].findings.push_back(
      {Severity::kError, "keys/key.pem", "others can read it", "chmod 600 keys/key.pem"});
  EXPECT_THAT(CheckSecurity(facts),
              Is(Grade::kFailure, "keys/key.pem others can read it", "chmod 600 keys/key.pem"));
  facts.trouble = "keys: has no identities";
  EXPECT_THAT(CheckSecurity(facts), Is(Grade::kFailure, "has no identities", "security init"));
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

TEST(DoctorFacts, AFolderWithoutIdentitiesSaysSo) {
  const test_support::TestFolder folder;
  EXPECT_THAT(ReadSecurity(folder.path(), true).trouble, HasSubstr("has no identities"));
  EXPECT_EQ(ReadSecurity({}, false).trouble, "");
}

TEST(DoctorFacts, ThereIsARouteToOneself) {
  EXPECT_EQ(LocalAddressTo("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(LocalAddressTo("no.such.host.invalid"), "");
  EXPECT_FALSE(MulticastComesBack("no address", std::chrono::milliseconds(1)));
}

/// Of the first host of a system file with these processes.
SystemFacts Facts(const std::string& processes) {
  const test_support::TestFolder folder;
  const std::string file = folder.Write(
      "system.yaml",
      "name: lab\nvariables: {cal: found.yaml}\nhosts:\n  - name: h\n    processes: [" + processes +
          "]\n");
  return FactsOf(ReadSystemFile(file, app::LoadYaml).hosts.front());
}

TEST(DoctorFacts, ASystemFileSaysWhatThisHostNeeds) {
  const std::string capture = "{name: c, component: capture}";
  EXPECT_TRUE(Facts(capture).has_genicam_camera);
  EXPECT_TRUE(Facts(capture).robot.empty());
  EXPECT_FALSE(Facts("{name: c, component: capture, set: {source: replay}}").has_genicam_camera);
  EXPECT_FALSE(Facts(capture + ", {name: v, component: virtual_camera}").has_genicam_camera);
  const SystemFacts model =
      Facts("{name: f, component: force_estimation, arguments: [rod, --calibration, $(cal)]}");
  EXPECT_FALSE(model.has_genicam_camera);
  EXPECT_EQ(model.robot, "rod");
  EXPECT_EQ(model.calibration, "found.yaml");
}

}  // namespace
}  // namespace palpate::command
