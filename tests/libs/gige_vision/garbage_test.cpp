// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <random>

#include "libs/core/clock.hpp"
#include "libs/gige_vision/control_channel.hpp"
#include "tests/libs/gige_vision/raw_client.hpp"
#include "tests/libs/gige_vision/test_device.hpp"

namespace palpate::gige_vision {
namespace {

constexpr unsigned kSeed = 20261121;

/// Commands that are nearly right: the fuzz that gets far.
class Garbage {
 public:
  explicit Garbage(unsigned seed) : random_{seed} {}

  Bytes Next() {
    Bytes body(Below(4) == 0 ? Below(600) : 4 * Below(8));
    for (auto& byte : body) byte = static_cast<std::uint8_t>(random_());
    if (body.size() >= 4 && Below(3) != 0) PlantAddress(&body);
    static constexpr std::array<std::uint16_t, 9> kCommands = {0x02, 0x04, 0x40, 0x80,  0x82,
                                                               0x84, 0x86, 0x88, 0xffff};
    Bytes packet = RawClient::Packet(kCommands[Below(kCommands.size())], body,
                                     static_cast<std::uint16_t>(random_()),
                                     static_cast<std::uint8_t>(random_()));
    if (Below(10) == 0) packet.resize(Below(packet.size() + 1));
    if (Below(10) == 0 && !packet.empty()) packet[Below(packet.size())] ^= 0xff;
    return packet;
  }

 private:
  std::size_t Below(std::size_t end) { return random_() % end; }

  void PlantAddress(Bytes* body) {
    static constexpr std::array<std::uint32_t, 6> kBases = {0,     0x900,   0xa00,
                                                            0xd00, 0x10000, 0x200000};
    const auto address = static_cast<std::uint32_t>(kBases[Below(kBases.size())] + Below(0x300));
    const Bytes bytes = Encode32(Below(8) == 0 ? address : address & ~3u);
    std::copy(bytes.begin(), bytes.end(), body->begin());
    if (body->size() >= 8 && Below(2) == 0) {  // a small value or size
      std::fill_n(body->begin() + 4, 3, std::uint8_t{0});
    }
  }

  std::mt19937 random_;
};

TEST(GarbageIn, NoPacketBreaksTheControlChannel) {
  std::printf("seed %u\n", kSeed);
  Garbage garbage(kSeed);
  CameraState state(TestSettings(), TestCamera(), Identity{}, WallNow_ns);
  ControlChannel control(&state);
  std::uint64_t resends = 0;
  control.on_resend = [&](const ResendRequest&) { ++resends; };
  const Peer client{0x7f00'0001, 5000};
  std::size_t answered = 0;
  Bytes take = Encode32(boot::kControlPrivilege);
  Put32(&take, kPrivilegeControl);
  for (int i = 0; i < 200'000; ++i) {
    if (!control.controlled()) {
      control.Answer(RawClient::Packet(0x82, take, static_cast<std::uint16_t>(1 + i % 65535), 1),
                     client, i);
    }
    const Bytes packet = garbage.Next();
    const Bytes answer = control.Answer(packet, client, i);
    if (answer.empty()) continue;
    ++answered;
    ASSERT_GE(answer.size(), kControlHeaderSize);
    ASSERT_LE(answer.size(), 576u);
    ASSERT_EQ(Get16(answer, 4), answer.size() - kControlHeaderSize);
    ASSERT_EQ(Get16(answer, 2), static_cast<std::uint16_t>(Get16(packet, 2) + 1));
  }
  EXPECT_GT(answered, 50'000u);  // the fuzz reaches the commands
  EXPECT_GT(resends, 100u);
  state.Plan();
}

class GarbageOnTheWire : public DeviceTest {};

TEST_F(GarbageOnTheWire, DeviceGoesOnStreaming) {
  std::printf("seed %u\n", kSeed);
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  RawClient client(TestAddress());
  client.StartStream();
  ASSERT_EQ(client.Write(RegisterOf(device->Describe(), "AcquisitionStart"), 1),
            ErrorCode::kSuccess);
  Garbage garbage(kSeed);
  RawClient stranger(TestAddress());
  for (int i = 0; i < 5000; ++i) {
    stranger.Send(garbage.Next());
    if (i % 64 == 0) {
      ASSERT_EQ(client.Read(boot::kStreamChannelCount), 1u);
    }
  }
  client.DrainStream();
  EXPECT_TRUE(client.NextPacket());
  EXPECT_TRUE(device->streaming());
}

TEST_F(GarbageOnTheWire, AnUnrulyClientCannotStopTheDevice) {
  std::printf("seed %u\n", kSeed + 1);
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  RawClient client(TestAddress());
  client.StartStream();
  Garbage garbage(kSeed + 1);
  const std::uint32_t start = RegisterOf(device->Describe(), "AcquisitionStart");
  for (int i = 0; i < 5000; ++i) {
    client.Send(garbage.Next());
    if (i % 100 == 0) client.Write(start, 1);
    while (client.Receive(0.0)) {
    }
  }
  RawClient other(TestAddress());
  EXPECT_TRUE(other.Ask(Command::kDiscovery, {}));
}

}  // namespace
}  // namespace palpate::gige_vision
