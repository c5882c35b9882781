// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstring>

#include "tests/libs/gige_vision/raw_client.hpp"
#include "tests/libs/gige_vision/test_device.hpp"

namespace palpate::gige_vision {
namespace {

constexpr std::uint8_t kNoAnswer = 0;

class Gvcp : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    if (IsSkipped()) return;
    MakeDevice();
    client = std::make_unique<RawClient>(TestAddress());
  }
  ErrorCode TakeControl() { return client->Write(boot::kControlPrivilege, kPrivilegeControl); }
  std::uint32_t At(const std::string& feature) const {
    return RegisterOf(device->Describe(), feature);
  }
  static std::string TextAt(const Bytes& memory, std::size_t at) {
    return reinterpret_cast<const char*>(memory.data() + at);
  }

  std::unique_ptr<RawClient> client;
};

TEST_F(Gvcp, DiscoveryTellsWhoItIs) {
  const auto answer = client->Ask(Command::kDiscovery, {});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, ErrorCode::kSuccess);
  ASSERT_EQ(answer->body.size(), kDiscoverySize);
  EXPECT_EQ(Get32(answer->body, boot::kVersion), 0x0002'0000u);
  EXPECT_EQ(Get32(answer->body, boot::kCurrentIp), FindInterface(TestAddress()).address);
  EXPECT_EQ(TextAt(answer->body, boot::kManufacturer), settings.vendor);
  EXPECT_EQ(TextAt(answer->body, boot::kModel), settings.model);
  EXPECT_EQ(TextAt(answer->body, boot::kSerial), settings.serial);
  EXPECT_EQ(TextAt(answer->body, boot::kUserName), settings.user_name);
}

TEST_F(Gvcp, BroadcastsFindAllDevicesOfTheInterface) {
  DeviceSettings other = settings;
  other.interface_address = TestAddress(1);
  other.serial = "other";
  const Device second(other, camera);
  for (const char* everybody : {"255.255.255.255", "127.255.255.255"}) {
    RawClient seeker(TestAddress());
    seeker.Send(
        RawClient::Packet(static_cast<std::uint16_t>(Command::kDiscovery), {}, 9, kAcknowledgeFlag),
        everybody);
    std::vector<std::string> serials;  // other tests' devices answer too
    const bool both = WaitUntil([&] {
      const auto answer = seeker.Receive(0.1);
      if (answer) serials.push_back(TextAt(answer->body, boot::kSerial));
      const auto has = [&](const std::string& serial) {
        return std::find(serials.begin(), serials.end(), serial) != serials.end();
      };
      return has(settings.serial) && has("other");
    });
    EXPECT_TRUE(both) << everybody;
  }
}

TEST_F(Gvcp, SeveralRegistersInOneCommand) {
  Bytes addresses = Encode32(boot::kTickFrequencyLow);
  Put32(&addresses, boot::kStreamChannelCount);
  Put32(&addresses, boot::kHeartbeatTimeout);
  const auto read = client->Ask(Command::kReadRegister, addresses);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->body.size(), 12u);
  EXPECT_EQ(Get32(read->body, 0), 1'000'000'000u);
  EXPECT_EQ(Get32(read->body, 4), 1u);
  EXPECT_EQ(Get32(read->body, 8), 60'000u);

  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  Bytes writes = Encode32(boot::kStreamPacketDelay);
  Put32(&writes, 1234);
  Put32(&writes, boot::kVersion);  // write-protected: the third is not tried any more
  Put32(&writes, 1);
  Put32(&writes, boot::kMessageRetries);
  Put32(&writes, 77);
  const auto written = client->Ask(Command::kWriteRegister, writes);
  ASSERT_TRUE(written);
  EXPECT_EQ(written->status, ErrorCode::kWriteProtect);
  EXPECT_EQ(Get32(written->body, 0), 1u);  // that many were written
  EXPECT_EQ(client->Read(boot::kStreamPacketDelay), 1234u);
  EXPECT_NE(client->Read(boot::kMessageRetries), 77u);
}

TEST_F(Gvcp, EachErrorHasItsCode) {
  std::uint32_t value = 0;
  EXPECT_EQ(client->Read(0x9000, &value), ErrorCode::kInvalidAddress);
  EXPECT_EQ(client->Read(0x0d01, &value), ErrorCode::kBadAlignment);
  EXPECT_EQ(client->Write(boot::kStreamPort, 1), ErrorCode::kAccessDenied);
  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  EXPECT_EQ(client->Write(boot::kCurrentIp, 1), ErrorCode::kWriteProtect);
  EXPECT_EQ(client->Write(0x9000, 1), ErrorCode::kInvalidAddress);
  EXPECT_EQ(client->Write(0x0d02, 1), ErrorCode::kBadAlignment);
  EXPECT_EQ(client->Write(At("AcquisitionMode"), 99), ErrorCode::kInvalidParameter);
  EXPECT_EQ(client->Write(At("Width"), 100'000), ErrorCode::kInvalidParameter);
  Bytes memory;
  EXPECT_EQ(client->ReadMemory(boot::kModel, 6, &memory), ErrorCode::kBadAlignment);
  EXPECT_EQ(client->ReadMemory(boot::kModel, 540, &memory), ErrorCode::kInvalidParameter);
  EXPECT_EQ(client->ReadMemory(0xfff0'0000, 4, &memory), ErrorCode::kInvalidAddress);
  EXPECT_EQ(client->WriteMemory(boot::kModel, Bytes(4)), ErrorCode::kWriteProtect);
  EXPECT_EQ(client->WriteMemory(boot::kUserName, Bytes(3)), ErrorCode::kBadAlignment);
  const auto unknown = client->Ask(static_cast<Command>(0x0100), {});
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->status, ErrorCode::kNotImplemented);
}

TEST_F(Gvcp, AWrongLengthIsAnInvalidHeader) {
  Bytes packet = RawClient::Packet(0x0080, Encode32(0), 5, kAcknowledgeFlag);
  packet[5] = 8;
  client->Send(packet);
  const auto answer = client->Receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, ErrorCode::kInvalidHeader);
}

TEST_F(Gvcp, UserNameStaysAndIsDiscovered) {
  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  ASSERT_EQ(client->WriteMemory(boot::kUserName, EncodeText("left eye", 16)), ErrorCode::kSuccess);
  ASSERT_EQ(client->Write(boot::kControlPrivilege, 0), ErrorCode::kSuccess);
  const auto answer = client->Ask(Command::kDiscovery, {});
  ASSERT_TRUE(answer);
  EXPECT_EQ(TextAt(answer->body, boot::kUserName), "left eye");
}

TEST_F(Gvcp, DescriptionIsWhereTheUrlSays) {
  Bytes url;
  ASSERT_EQ(client->ReadMemory(boot::kFirstUrl, 512, &url), ErrorCode::kSuccess);
  unsigned address = 0;
  unsigned size = 0;
  ASSERT_EQ(std::sscanf(TextAt(url, 0).c_str(), "Local:%*[^;];%x;%x", &address, &size), 2);
  std::string xml;
  for (unsigned at = 0; at < size; at += 512) {
    Bytes piece;
    const auto count = static_cast<std::uint16_t>(std::min(512u, size - at));
    ASSERT_EQ(client->ReadMemory(address + at, count, &piece), ErrorCode::kSuccess);
    xml.append(piece.begin(), piece.end());
  }
  EXPECT_EQ(xml.substr(0, device->Describe().size()), device->Describe());
}

TEST_F(Gvcp, RepeatedCommandIsAnsweredAgainButNotExecutedAgain) {
  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  Bytes latch = Encode32(boot::kTimestampControl);
  Put32(&latch, kTimestampLatch);
  ASSERT_TRUE(client->Ask(Command::kWriteRegister, latch, 500));
  const std::uint32_t first = client->Read(boot::kTimestampLow);
  const auto again = client->Ask(Command::kWriteRegister, latch, 500);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, ErrorCode::kSuccess);
  EXPECT_EQ(client->Read(boot::kTimestampLow), first);
  ASSERT_TRUE(client->Ask(Command::kWriteRegister, latch, 501));
  EXPECT_NE(client->Read(boot::kTimestampLow), first);
}

TEST_F(Gvcp, CommandWithoutAnswerIsExecuted) {
  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  Bytes body = Encode32(boot::kMessageRetries);
  Put32(&body, 9);
  client->Send(RawClient::Packet(0x0082, body, 777, kNoAnswer));
  client->Send(RawClient::Packet(0x0080, Encode32(boot::kMessageRetries), 778, kAcknowledgeFlag));
  const auto answer = client->Receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->id, 778);
  EXPECT_EQ(Get32(answer->body, 0), 9u);
}

TEST_F(Gvcp, TimestampIsResetAndLatched) {
  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  const auto latched_ns = [&] {
    EXPECT_EQ(client->Write(boot::kTimestampControl, kTimestampLatch), ErrorCode::kSuccess);
    const std::uint64_t high = client->Read(boot::kTimestampHigh);
    return (high << 32) | client->Read(boot::kTimestampLow);
  };
  const std::uint64_t since_epoch_ns = latched_ns();
  EXPECT_GT(latched_ns(), since_epoch_ns);
  EXPECT_EQ(client->Write(boot::kTimestampControl, kTimestampReset), ErrorCode::kSuccess);
  EXPECT_LT(latched_ns(), 60'000'000'000u);
}

TEST_F(Gvcp, ForceIpIsForThisMacAddressOnly) {
  const auto found = client->Ask(Command::kDiscovery, {});
  ASSERT_TRUE(found);
  Bytes body(56);
  std::copy_n(found->body.begin() + boot::kMacHigh, 8, body.begin());
  const auto kept = client->Ask(Command::kForceIp, body);  // 0: as it is
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->status, ErrorCode::kSuccess);
  body[20] = 10;
  const auto refused = client->Ask(Command::kForceIp, body);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, ErrorCode::kInvalidParameter);
  body[7] ^= 1;
  client->Send(
      RawClient::Packet(static_cast<std::uint16_t>(Command::kForceIp), body, 6, kAcknowledgeFlag));
  // No device answers for another: the first answer is the next command's.
  client->Send(
      RawClient::Packet(static_cast<std::uint16_t>(Command::kDiscovery), {}, 7, kAcknowledgeFlag));
  const auto next = client->Receive();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->id, 7);
}

TEST_F(Gvcp, PacketSizeIsRoundedToWhatTheDeviceCan) {
  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  const auto set = [&](std::uint32_t asked) {
    EXPECT_EQ(client->Write(boot::kStreamPacketSize, asked), ErrorCode::kSuccess);
    return client->Read(boot::kStreamPacketSize);
  };
  EXPECT_EQ(set(1503), 1500u);
  EXPECT_EQ(set(10), kMinPacketSize);
  EXPECT_EQ(set(65535), kMaxPacketSize);
  EXPECT_EQ(set(kDoNotFragment | 1400), kDoNotFragment | 1400);
}

TEST_F(Gvcp, TestPacketHasTheSizeThatIsSet) {
  client->StartStream();
  for (const std::uint32_t size : {576u, 1500u, 9000u}) {
    ASSERT_EQ(client->Write(boot::kStreamPacketSize, kFireTestPacket | size), ErrorCode::kSuccess);
    const auto packet = client->NextPacket();
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->bytes.size(), size - kUdpOverhead);
    EXPECT_EQ(client->Read(boot::kStreamPacketSize), size);  // the bit clears itself
  }
}

TEST_F(Gvcp, SelectorsChangeWhatIsRead) {
  ASSERT_EQ(TakeControl(), ErrorCode::kSuccess);
  const auto width_of = [&](std::uint32_t component) {
    EXPECT_EQ(client->Write(At("ComponentSelector"), component), ErrorCode::kSuccess);
    return static_cast<int>(client->Read(At("Width")));
  };
  EXPECT_EQ(width_of(0), camera.depth.width_px);
  EXPECT_EQ(width_of(1), camera.color.width_px);
  EXPECT_EQ(client->Write(At("ComponentSelector"), 3), ErrorCode::kInvalidParameter);
  const auto coefficient = [&](std::uint32_t index) {
    EXPECT_EQ(client->Write(At("PalpateDepthDistortionSelector"), index), ErrorCode::kSuccess);
    Bytes value;
    EXPECT_EQ(client->ReadMemory(At("PalpateDepthDistortion"), 8, &value), ErrorCode::kSuccess);
    return DecodeDouble(value);
  };
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(coefficient(i), camera.depth.distortion[i]);
}

}  // namespace
}  // namespace palpate::gige_vision
