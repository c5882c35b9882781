// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "libs/core/error.hpp"
#include "tests/libs/gige_vision/raw_client.hpp"
#include "tests/libs/gige_vision/test_device.hpp"

namespace palpate::gige_vision {
namespace {

class Lifetime : public DeviceTest {
 protected:
  static std::size_t OpenFiles() {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator("/proc/self/fd")) {
      ++count;
    }
    return count;
  }
};

TEST_F(Lifetime, PortIsOneDevicesAndFreeWhenItGoes) {
  MakeDevice();
  try {
    const Device second(settings, camera);
    FAIL() << "two devices have one port";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find(TestAddress()), std::string::npos) << error.what();
  }
  device.reset();
  EXPECT_NO_THROW(MakeDevice());
}

TEST_F(Lifetime, AddressMustBeOfThisMachine) {
  settings.interface_address = "203.0.113.7";  // of documents
  EXPECT_THROW(MakeDevice(), RunError);
  settings.interface_address = "here";
  EXPECT_THROW(MakeDevice(), InputError);
}

TEST_F(Lifetime, SettingsAreRefusedThatMakeNoSense) {
  settings.rate_hz = 0.0;
  EXPECT_THROW(MakeDevice(), InputError);
  settings = TestSettings();
  settings.impairment.loss = 1.5;
  EXPECT_THROW(MakeDevice(), InputError);
}

TEST_F(Lifetime, FiftyKillsAndReturnsLeaveNothingBehind) {
  MakeDevice();
  const std::size_t open_files = OpenFiles();
  const std::uint32_t start = RegisterOf(device->Describe(), "AcquisitionStart");
  const rgbd::RgbdFrame frame = TestFrame(camera, 0, 1);
  for (int i = 0; i < 50; ++i) {
    device.reset();
    MakeDevice();
    RawClient client(TestAddress());
    client.StartStream();
    ASSERT_EQ(client.Write(start, 1), ErrorCode::kSuccess);
    device->Send(frame);  // killed while it is being sent
    ASSERT_TRUE(client.NextPacket());
  }
  EXPECT_EQ(OpenFiles(), open_files);
}

TEST_F(Lifetime, KilledClientDoesNotLockTheNextOneOut) {
  settings.heartbeat_timeout_s = 1.0;
  MakeDevice();
  std::array<int, 2> ready{};
  ASSERT_EQ(pipe(ready.data()), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    RawClient client(TestAddress());
    client.StartStream();
    if (write(ready[1], "x", 1) != 1) _exit(1);
    while (true) pause();
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  RawClient next(TestAddress());
  EXPECT_EQ(next.Write(boot::kControlPrivilege, kPrivilegeControl), ErrorCode::kAccessDenied);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(WaitUntil([&] {
    return next.Write(boot::kControlPrivilege, kPrivilegeControl) == ErrorCode::kSuccess;
  }));
  close(ready[0]);
  close(ready[1]);
}

}  // namespace
}  // namespace palpate::gige_vision
