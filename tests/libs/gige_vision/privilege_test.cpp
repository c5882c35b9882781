// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/clock.hpp"
#include "libs/gige_vision/control_channel.hpp"
#include "tests/libs/gige_vision/raw_client.hpp"
#include "tests/libs/gige_vision/test_device.hpp"

namespace palpate::gige_vision {
namespace {

class Privilege : public DeviceTest {
 protected:
  ErrorCode Take(RawClient* client, std::uint32_t privilege) {
    return client->Write(boot::kControlPrivilege, privilege);
  }
};

TEST_F(Privilege, OneClientControlsOthersOnlyRead) {
  MakeDevice();
  RawClient first(TestAddress());
  RawClient second(TestAddress());
  EXPECT_EQ(first.Write(boot::kMessageRetries, 5), ErrorCode::kAccessDenied);  // not held yet
  ASSERT_EQ(Take(&first, kPrivilegeControl), ErrorCode::kSuccess);
  EXPECT_EQ(Take(&second, kPrivilegeControl), ErrorCode::kAccessDenied);
  EXPECT_EQ(Take(&second, 0), ErrorCode::kAccessDenied);
  EXPECT_EQ(second.Write(boot::kMessageRetries, 5), ErrorCode::kAccessDenied);
  EXPECT_EQ(second.Read(boot::kControlPrivilege), kPrivilegeControl);
  EXPECT_EQ(first.Write(boot::kMessageRetries, 5), ErrorCode::kSuccess);
  EXPECT_EQ(second.Read(boot::kMessageRetries), 5u);
  EXPECT_EQ(second.Read(boot::kPrimaryAddress), first.own_address());
}

TEST_F(Privilege, ExclusiveAccessHidesTheDevice) {
  MakeDevice();
  RawClient first(TestAddress());
  RawClient second(TestAddress());
  ASSERT_EQ(Take(&first, kPrivilegeExclusive), ErrorCode::kSuccess);
  std::uint32_t value = 0;
  Bytes memory;
  EXPECT_EQ(second.Read(boot::kVersion, &value), ErrorCode::kAccessDenied);
  EXPECT_EQ(second.ReadMemory(boot::kModel, 32, &memory), ErrorCode::kAccessDenied);
  EXPECT_TRUE(second.Ask(Command::kDiscovery, {}));  // it can be found
  EXPECT_EQ(Take(&first, kPrivilegeControl), ErrorCode::kSuccess);
  EXPECT_EQ(second.Read(boot::kVersion, &value), ErrorCode::kSuccess);
}

TEST_F(Privilege, IsFreeAtOnceWhenReleased) {
  MakeDevice();
  RawClient first(TestAddress());
  RawClient second(TestAddress());
  ASSERT_EQ(Take(&first, kPrivilegeControl), ErrorCode::kSuccess);
  ASSERT_EQ(Take(&first, 0), ErrorCode::kSuccess);
  EXPECT_EQ(Take(&second, kPrivilegeExclusive), ErrorCode::kSuccess);
  EXPECT_EQ(Take(&first, kPrivilegeControl), ErrorCode::kAccessDenied);
}

TEST_F(Privilege, SwitchOverIsNotOffered) {
  MakeDevice();
  RawClient client(TestAddress());
  EXPECT_EQ(Take(&client, 0x4 | kPrivilegeControl), ErrorCode::kInvalidParameter);
  EXPECT_EQ(client.Read(boot::kControlPrivilege), 0u);
}

TEST_F(Privilege, SilentClientLosesItAndItsStream) {
  settings.heartbeat_timeout_s = 1.0;
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  RawClient client(TestAddress());
  EXPECT_EQ(client.Read(boot::kHeartbeatTimeout), 1000u);
  client.StartStream();
  ASSERT_EQ(client.Write(RegisterOf(device->Describe(), "AcquisitionStart"), 1),
            ErrorCode::kSuccess);
  ASSERT_TRUE(client.NextPacket());
  EXPECT_TRUE(device->streaming());
  ASSERT_TRUE(WaitUntil([&] { return !device->streaming(); }));
  RawClient other(TestAddress());
  EXPECT_EQ(other.Read(boot::kControlPrivilege), 0u);
  EXPECT_EQ(other.Read(boot::kStreamPort), 0u);
  EXPECT_EQ(client.Write(boot::kMessageRetries, 5), ErrorCode::kAccessDenied);
  EXPECT_EQ(Take(&other, kPrivilegeControl), ErrorCode::kSuccess);
}

/// The control channel with time in the test's hand.
class Heartbeat : public testing::Test {
 protected:
  static constexpr std::int64_t kMs = 1'000'000;

  ErrorCode Write(std::uint32_t address, std::uint32_t value, std::int64_t now_ms,
                  std::uint16_t id = 0) {
    Bytes body = Encode32(address);
    Put32(&body, value);
    const auto command = static_cast<std::uint16_t>(Command::kWriteRegister);
    const Bytes packet = RawClient::Packet(command, body, id != 0 ? id : ++id_, kAcknowledgeFlag);
    const Bytes answer = control.Answer(packet, client, now_ms * kMs);
    return static_cast<ErrorCode>(Get16(answer, 0));
  }
  bool ControlledAt(std::int64_t now_ms) {
    control.CheckHeartbeat(now_ms * kMs);
    return control.controlled();
  }

  CameraState state{TestSettings(), TestCamera(), Identity{}, WallNow_ns};
  ControlChannel control{&state};
  const Peer client{0x7f00'0001, 5000};
  std::uint16_t id_ = 0;
};

TEST_F(Heartbeat, AnyCommandIsOneEvenARepeatedOne) {
  ASSERT_EQ(Write(boot::kControlPrivilege, kPrivilegeControl, 0), ErrorCode::kSuccess);
  EXPECT_EQ(control.Deadline_ns(), 3000 * kMs);
  EXPECT_EQ(Write(boot::kMessageRetries, 4, 2900, 77), ErrorCode::kSuccess);
  EXPECT_EQ(Write(boot::kMessageRetries, 4, 5800, 77), ErrorCode::kSuccess);
  EXPECT_EQ(control.Deadline_ns(), 8800 * kMs);
  const Bytes read = RawClient::Packet(static_cast<std::uint16_t>(Command::kReadRegister),
                                       Encode32(boot::kControlPrivilege), 78, kAcknowledgeFlag);
  control.Answer(read, client, 8700 * kMs);
  EXPECT_TRUE(ControlledAt(11'699));
  EXPECT_FALSE(ControlledAt(11'700));
}

TEST_F(Heartbeat, AStrangersCommandIsNone) {
  ASSERT_EQ(Write(boot::kControlPrivilege, kPrivilegeControl, 0), ErrorCode::kSuccess);
  const Bytes read = RawClient::Packet(static_cast<std::uint16_t>(Command::kReadRegister),
                                       Encode32(boot::kControlPrivilege), 78, kAcknowledgeFlag);
  control.Answer(read, {client.address, 5001}, 2999 * kMs);
  EXPECT_FALSE(ControlledAt(3000));
}

TEST_F(Heartbeat, TimeoutIsSetInItsLimits) {
  ASSERT_EQ(Write(boot::kControlPrivilege, kPrivilegeControl, 0), ErrorCode::kSuccess);
  ASSERT_EQ(Write(boot::kHeartbeatTimeout, 700, 0), ErrorCode::kSuccess);
  EXPECT_EQ(control.Deadline_ns(), 700 * kMs);
  ASSERT_EQ(Write(boot::kHeartbeatTimeout, 0, 0), ErrorCode::kSuccess);
  EXPECT_EQ(control.Deadline_ns(), kMinHeartbeatTimeout_ms * kMs);
}

TEST_F(Heartbeat, CanBeDisabled) {
  ASSERT_EQ(Write(boot::kControlPrivilege, kPrivilegeControl, 0), ErrorCode::kSuccess);
  ASSERT_EQ(Write(boot::kControlConfiguration, kHeartbeatDisable, 0), ErrorCode::kSuccess);
  EXPECT_EQ(control.Deadline_ns(), std::nullopt);
  EXPECT_TRUE(ControlledAt(1'000'000'000));
  ASSERT_EQ(Write(boot::kControlConfiguration, 0, 1'000'000'000), ErrorCode::kSuccess);
  EXPECT_FALSE(ControlledAt(1'000'003'000));
}

TEST_F(Heartbeat, LossEndsAcquisitionAndClosesTheChannels) {
  int closed = 0;
  state.on_stream_channel = [&](bool open) { closed += open ? 0 : 1; };
  ASSERT_EQ(Write(boot::kControlPrivilege, kPrivilegeControl, 0), ErrorCode::kSuccess);
  ASSERT_EQ(Write(boot::kStreamAddress, client.address, 0), ErrorCode::kSuccess);
  ASSERT_EQ(Write(boot::kStreamPort, 6000, 0), ErrorCode::kSuccess);
  ASSERT_EQ(Write(state.bank().AddressOf("TLParamsLocked"), 1, 0), ErrorCode::kSuccess);
  ASSERT_EQ(Write(state.bank().AddressOf("AcquisitionStart"), 1, 0), ErrorCode::kSuccess);
  ASSERT_TRUE(state.Plan());
  EXPECT_FALSE(ControlledAt(3000));
  EXPECT_FALSE(state.Plan());
  EXPECT_EQ(closed, 1);
  EXPECT_EQ(state.bank().Get("TLParamsLocked"), 0u);
}

}  // namespace
}  // namespace palpate::gige_vision
