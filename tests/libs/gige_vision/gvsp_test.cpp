// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <map>
#include <set>

#include "libs/core/clock.hpp"
#include "tests/libs/gige_vision/raw_client.hpp"
#include "tests/libs/gige_vision/test_device.hpp"

namespace palpate::gige_vision {
namespace {

class Gvsp : public DeviceTest {
 protected:
  using Packets = std::map<std::uint32_t, RawStreamPacket>;

  void Stream(std::uint32_t packet_size = 1500) {
    if (!device) MakeDevice();
    client = std::make_unique<RawClient>(TestAddress());
    client->StartStream(packet_size);
  }
  void Set(const std::string& feature, std::uint32_t value) {
    ASSERT_EQ(client->Write(RegisterOf(device->Describe(), feature), value), ErrorCode::kSuccess)
        << feature;
  }
  /// Sends one frame and collects its packets up to the trailer.
  Packets SendOne(const rgbd::RgbdFrame& frame) {
    device->Send(frame);
    Packets packets;
    while (true) {
      auto packet = client->NextPacket();
      if (!packet) break;
      const bool last = packet->format == PacketFormat::kTrailer;
      packets[packet->packet_id] = std::move(*packet);
      if (last) break;
    }
    EXPECT_FALSE(packets.empty());
    return packets;
  }
  void WaitForFrames(std::uint64_t count) {
    ASSERT_TRUE(WaitUntil([&] { return device->counters().frames_sent >= count; }));
  }

  std::unique_ptr<RawClient> client;
};

TEST_F(Gvsp, LeaderDescribesTheParts) {
  Stream();
  Set("AcquisitionStart", 1);
  const std::int64_t stamp_ns = WallNow_ns();
  const Packets packets = SendOne(TestFrame(camera, 0, stamp_ns));
  const RawStreamPacket& leader = packets.at(0);
  ASSERT_EQ(leader.bytes.size(), 20u + 12u + 3u * 48u);
  EXPECT_TRUE(leader.extended);
  EXPECT_EQ(leader.block_id, 1u);
  EXPECT_EQ(leader.format, PacketFormat::kLeader);
  EXPECT_EQ(leader.bytes[7], 3u);               // parts
  EXPECT_EQ(Get16(leader.bytes, 22), 0x000au);  // payload type
  EXPECT_EQ(Get64(leader.bytes, 24), static_cast<std::uint64_t>(stamp_ns));
  const std::size_t first = 32;
  EXPECT_EQ(Get16(leader.bytes, first), 0x0005u);  // 3-D image
  EXPECT_EQ(Get32(leader.bytes, first + 4), 2u * 90u * 62u);
  EXPECT_EQ(Get32(leader.bytes, first + 8), kCoord3dC16);
  EXPECT_EQ(Get16(leader.bytes, first + 20), 4u);  // purpose: Range
  EXPECT_EQ(Get32(leader.bytes, first + 24), 90u);
  EXPECT_EQ(Get32(leader.bytes, first + 28), 62u);
  EXPECT_EQ(Get16(leader.bytes, first + 48), 0x0001u);      // 2-D image
  EXPECT_EQ(Get16(leader.bytes, first + 48 + 20), 1u);      // Intensity
  EXPECT_EQ(Get16(leader.bytes, first + 2 * 48), 0x0009u);  // confidence map
  EXPECT_EQ(Get16(leader.bytes, first + 2 * 48 + 20), 6u);  // Confidence
}

TEST_F(Gvsp, PacketsAreOfTheSizeThatWasAskedForAndCarryEveryByte) {
  Stream(1000);
  Set("AcquisitionStart", 1);
  const rgbd::RgbdFrame frame = TestFrame(camera, 3, 1);
  const Packets packets = SendOne(frame);
  Bytes depth(2u * 90u * 62u);
  for (const auto& [id, packet] : packets) {
    EXPECT_LE(packet.bytes.size(), 1000u - kUdpOverhead);
    if (packet.format != PacketFormat::kMultipartPayload || packet.bytes[20] != 0) continue;
    const std::size_t offset = Get32(packet.bytes, 24);
    std::copy(packet.bytes.begin() + 28, packet.bytes.end(),
              depth.begin() + static_cast<std::ptrdiff_t>(offset));
  }
  EXPECT_EQ(packets.size(), packets.rbegin()->first + 1u);  // none is missing
  EXPECT_EQ(std::memcmp(depth.data(), frame.depth.values.data(), depth.size()), 0);
}

TEST_F(Gvsp, OneComponentIsAnImageAlsoWithShortIds) {
  Stream();
  ASSERT_EQ(client->Write(boot::kStreamConfiguration, 0), ErrorCode::kSuccess);
  for (const std::uint32_t component : {1u, 2u}) {
    Set("ComponentSelector", component);
    Set("ComponentEnable", 0);
  }
  EXPECT_EQ(client->Read(RegisterOf(device->Describe(), "PayloadSize")), 2u * 90u * 62u);
  Set("AcquisitionStart", 1);
  const Packets packets = SendOne(TestFrame(camera, 0, 5));
  const RawStreamPacket& leader = packets.at(0);
  EXPECT_FALSE(leader.extended);
  EXPECT_EQ(leader.block_id, 1u);
  ASSERT_EQ(leader.bytes.size(), 8u + 36u);
  EXPECT_EQ(Get16(leader.bytes, 10), 0x0001u);
  EXPECT_EQ(Get32(leader.bytes, 20), kCoord3dC16);
  EXPECT_EQ(packets.at(1).format, PacketFormat::kImagePayload);
  EXPECT_EQ(packets.at(1).bytes.size(), 1500u - kUdpOverhead);
}

TEST_F(Gvsp, ARegionIsCutOut) {
  Stream();
  for (const std::uint32_t component : {1u, 2u}) {
    Set("ComponentSelector", component);
    Set("ComponentEnable", 0);
  }
  Set("ComponentSelector", 0);
  Set("Width", 20);
  Set("Height", 17);
  Set("OffsetX", 30);
  Set("OffsetY", 40);
  Set("AcquisitionStart", 1);
  const rgbd::RgbdFrame frame = TestFrame(camera, 0, 5);
  const Packets packets = SendOne(frame);
  const Bytes& leader = packets.at(0).bytes;
  EXPECT_EQ(Get32(leader, 20 + 16), 20u);
  EXPECT_EQ(Get32(leader, 20 + 24), 30u);
  EXPECT_EQ(Get32(leader, 20 + 28), 40u);
  const Bytes& pixels = packets.at(1).bytes;
  ASSERT_EQ(pixels.size(), 20u + 2u * 20u * 17u);
  for (int v = 0; v < 17; ++v) {
    EXPECT_EQ(std::memcmp(pixels.data() + 20 + 40 * v, frame.depth.Pixel(30, 40 + v), 40), 0) << v;
  }
}

TEST_F(Gvsp, LostPacketsAreSentAgainOnRequest) {
  Stream();
  Set("AcquisitionStart", 1);
  const Packets packets = SendOne(TestFrame(camera, 0, 5));
  WaitForFrames(1);
  client->AskResend(1, 2, 4, true);
  for (std::uint32_t id = 2; id <= 4; ++id) {
    const auto again = client->NextPacket();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->packet_id, id);
    EXPECT_EQ(again->flags, 1u);  // a resend
    EXPECT_TRUE(
        std::equal(again->bytes.begin() + 4, again->bytes.end(), packets.at(id).bytes.begin() + 4));
  }
  EXPECT_TRUE(WaitUntil([&] { return device->counters().packets_resent == 3; }));
}

TEST_F(Gvsp, OpenEndedRequestGivesTheRestOfTheBlock) {
  Stream();
  Set("AcquisitionStart", 1);
  const Packets packets = SendOne(TestFrame(camera, 0, 5));
  WaitForFrames(1);
  client->AskResend(1, 1, 0xffff'ffff, true);
  for (std::uint32_t id = 1; id < packets.size(); ++id) {
    const auto again = client->NextPacket();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->packet_id, id);
  }
}

TEST_F(Gvsp, PacketsOfABlockThatIsGoneAreRefused) {
  Stream();
  Set("AcquisitionStart", 1);
  for (int i = 0; i < 12; ++i) SendOne(TestFrame(camera, i, 5));
  WaitForFrames(12);
  client->AskResend(1, 3, 3, true);
  const auto refusal = client->NextPacket();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, static_cast<std::uint16_t>(ErrorCode::kPacketUnavailable));
  EXPECT_EQ(refusal->block_id, 1u);
  EXPECT_EQ(refusal->packet_id, 3u);
  EXPECT_EQ(device->counters().resend_refused, 1u);
}

TEST_F(Gvsp, StrangersGetNoResends) {
  Stream();
  Set("AcquisitionStart", 1);
  SendOne(TestFrame(camera, 0, 5));
  WaitForFrames(1);
  RawClient stranger(TestAddress(), TestAddress(3));
  stranger.AskResend(1, 2, 2, true);
  // Answered in order: once this is, the request has been seen.
  EXPECT_TRUE(stranger.Ask(Command::kDiscovery, {}));
  EXPECT_EQ(device->counters().packets_resent, 0u);
}

TEST_F(Gvsp, LossIsOfTheShareThatIsSetAndTheSameForASeed) {
  settings.impairment = {.loss = 0.3, .resend_loss = 0.0, .seed = 7};
  const auto missing = [&] {
    device.reset();
    Stream(576);
    Set("AcquisitionStart", 1);
    std::set<std::pair<std::uint64_t, std::uint32_t>> seen;
    for (std::uint64_t i = 1; i <= 10; ++i) {
      device->Send(TestFrame(camera, 0, 5));
      WaitForFrames(i);
      // One frame fits into the receive buffer of any kernel, ten do not.
      while (const auto packet = client->NextPacket(0.02)) {
        seen.emplace(packet->block_id, packet->packet_id);
      }
    }
    return seen;
  };
  const auto first = missing();
  const DeviceCounters counters = device->counters();
  const double total = static_cast<double>(counters.packets_sent + counters.packets_withheld);
  EXPECT_NEAR(static_cast<double>(counters.packets_withheld) / total, 0.3, 0.06);
  EXPECT_EQ(first.size(), counters.packets_sent);
  EXPECT_EQ(missing(), first);
  settings.impairment.seed = 8;
  EXPECT_NE(missing(), first);
}

TEST_F(Gvsp, AFramesPacketsAreSpreadOverAQuarterOfItsPeriod) {
  constexpr double kPeriod_s = 2.0;
  settings.rate_hz = 1.0 / kPeriod_s;
  Stream(576);
  Set("AcquisitionStart", 1);
  const auto begin = std::chrono::steady_clock::now();
  SendOne(TestFrame(camera, 0, 5));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(took.count(), 0.2 * kPeriod_s);
  EXPECT_LE(took.count(), 0.5 * kPeriod_s);
}

TEST_F(Gvsp, PacketDelayIsKept) {
  Stream();
  const std::uint32_t delay_ns = 2'000'000;  // without it all would be there in 20 ms
  ASSERT_EQ(client->Write(boot::kStreamPacketDelay, delay_ns), ErrorCode::kSuccess);
  Set("AcquisitionStart", 1);
  const auto begin = std::chrono::steady_clock::now();
  const Packets packets = SendOne(TestFrame(camera, 0, 5));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(took.count(), 2e-3 * static_cast<double>(packets.size() - 1));
}

TEST_F(Gvsp, FramesThatComeTooFastAreSkippedAndCounted) {
  settings.rate_hz = 0.2;  // a frame is spread over 1.25 s
  Stream();
  Set("AcquisitionStart", 1);
  const rgbd::RgbdFrame frame = TestFrame(camera, 0, 5);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 5; ++i) device->Send(frame);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(took.count(), 1.0);  // does not wait for the network
  EXPECT_GE(device->counters().frames_skipped, 3u);
}

TEST_F(Gvsp, SingleAndMultiFrameEndByThemselves) {
  Stream();
  Set("AcquisitionMode", 2);
  Set("AcquisitionFrameCount", 3);
  Set("AcquisitionStart", 1);
  for (std::uint64_t i = 1; i <= 3; ++i) {
    device->Send(TestFrame(camera, 0, 5));
    WaitForFrames(i);
  }
  EXPECT_FALSE(device->streaming());
  Set("AcquisitionMode", 1);
  Set("AcquisitionStart", 1);
  device->Send(TestFrame(camera, 0, 5));
  WaitForFrames(4);
  EXPECT_FALSE(device->streaming());
}

TEST_F(Gvsp, ALowerRateLeavesOutFrames) {
  Stream();
  const std::string xml = device->Describe();
  Set("AcquisitionFrameRateEnable", 1);
  ASSERT_EQ(client->WriteMemory(RegisterOf(xml, "AcquisitionFrameRate"), EncodeDouble(10.0)),
            ErrorCode::kSuccess);
  Set("AcquisitionStart", 1);
  for (int i = 0; i < 30; ++i) {
    device->Send(TestFrame(camera, 0, 5));
    WaitForFrames(static_cast<std::uint64_t>((i + 1) / 3));
  }
  EXPECT_EQ(device->counters().frames_sent, 10u);
  EXPECT_EQ(device->counters().frames_skipped, 0u);
}

}  // namespace
}  // namespace palpate::gige_vision
