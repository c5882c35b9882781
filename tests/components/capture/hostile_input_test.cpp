// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <random>

#include "components/capture/aravis/aravis_camera.hpp"
#include "components/capture/genicam/device_setup.hpp"
#include "components/capture/link/frame_decoder.hpp"
#include "components/capture/network/packet_size.hpp"
#include "components/capture/network/stream_filter.hpp"
#include "tests/components/capture/simulated_camera.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::capture {
namespace {

using testing::HasSubstr;

std::unique_ptr<AravisCamera> OpenFake(const std::string& description_file, std::string* reason) {
  CameraTarget target;
  target.fake = true;
  target.fake_description = description_file;
  return AravisCamera::Open(target, "", reason);
}

/// Aravis' own description of its fake camera, a sound one.
std::string SoundDescription() {
  std::string reason;
  const auto camera = OpenFake("", &reason);
  EXPECT_NE(camera, nullptr) << reason;
  return camera ? camera->Description() : "";
}

/// Where the texts between `begin` and '<' or '"' stand.
std::vector<std::pair<std::size_t, std::size_t>> FindAll(const std::string& text,
                                                         const std::string& begin) {
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    at += begin.size();
    places.emplace_back(at, text.find_first_of("<\"", at) - at);
  }
  return places;
}

void ReplaceOne(std::string* xml, const std::string& begin, const std::string& by,
                std::mt19937& random) {
  const auto places = FindAll(*xml, begin);
  if (places.empty()) return;
  const auto [at, size] = places[random() % places.size()];
  xml->replace(at, size, by);
}

std::string Spoil(std::string xml, std::mt19937& random) {
  static const std::array<const char*, 8> kNumbers = {
      "nan", "-1", "1e400", "", "abc", "0", "0x", "99999999999999999999999"};
  static const std::array<const char*, 7> kFormulas = {"1/0", "((((",  "A+",   "X**Y",
                                                       "$",   "SEL/0", "1 ? 2"};
  const auto names = FindAll(xml, " Name=\"");
  if (names.empty()) return xml;
  const auto [name_at, name_size] = names[random() % names.size()];
  const std::string name = xml.substr(name_at, name_size);
  const std::size_t at = random() % xml.size();
  switch (random() % 7) {
    case 0: xml[at] = static_cast<char>(random()); break;
    case 1: xml.erase(at, random() % 200); break;
    case 2: xml.resize(at); break;
    case 3: ReplaceOne(&xml, "<pValue>", name, random); break;
    case 4: ReplaceOne(&xml, "<pVariable Name=\"", name, random); break;
    case 5: ReplaceOne(&xml, "<Value>", kNumbers[random() % kNumbers.size()], random); break;
    default: ReplaceOne(&xml, "<Formula>", kFormulas[random() % kFormulas.size()], random);
  }
  return xml.empty() ? " " : xml;
}

TEST(HostileInput, SpoiltDescriptionsAreRefusedOrWorkInPart) {
  constexpr unsigned kSeed = 20261121;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  const test_support::TestFolder folder;
  const std::string sound = SoundDescription();
  ASSERT_GT(sound.size(), 1000u);
  int opened = 0;
  for (int round = 0; round < 150; ++round) {
    std::string xml = sound;
    for (int change = 0; change <= round % 3; ++change) xml = Spoil(xml, random);
    std::string reason;
    const auto camera = OpenFake(folder.Write("description.xml", xml).string(), &reason);
    if (!camera) {
      EXPECT_FALSE(reason.empty());
      continue;
    }
    ++opened;
    DeviceWishes wishes;
    wishes.role = DeviceRole::kColorOnly;
    const DeviceSetup setup = ConfigureDevice(camera->features(), wishes);
    EXPECT_TRUE(setup.status.ok() || !setup.status.message().empty());
    wishes.role = DeviceRole::kDepthAndColor;
    EXPECT_FALSE(ConfigureDevice(camera->features(), wishes).status.ok());
  }
  EXPECT_GT(opened, 30);
  EXPECT_LT(opened, 150);
}

TEST(HostileInput, AValueThatIsComputedFromItselfIsRefused) {
  const test_support::TestFolder folder;
  std::string xml = SoundDescription();
  const std::string link = "<pValue>PixelFormatRegister</pValue>";
  const std::size_t at = xml.find(link);
  ASSERT_NE(at, std::string::npos);
  xml.replace(at, link.size(), "<pValue>PixelFormat</pValue>");
  std::string reason;
  EXPECT_EQ(OpenFake(folder.Write("circle.xml", xml).string(), &reason), nullptr);
  EXPECT_THAT(reason, HasSubstr("PixelFormat from itself"));
}

/// Sends GVSP packets of nonsense, from an address of its own, to a stream.
class Babbler {
 public:
  Babbler(const std::string& from, const std::string& to, int port, unsigned seed)
      : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)), random_(seed) {
    sockaddr_in own = Inet(from, 0);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&own), sizeof(own)), 0);
    target_ = Inet(to, port);
  }
  ~Babbler() { close(socket_); }

  /// `frame_id`: near the one that the camera sends just now.
  void Send(std::uint64_t frame_id) {
    std::array<std::uint8_t, 1500> packet;
    for (auto& byte : packet) byte = static_cast<std::uint8_t>(random_());
    packet[0] = packet[1] = 0;  // status: success
    packet[4] = static_cast<std::uint8_t>(random_() % 8 | (random_() % 8 != 0 ? 0x80u : 0u));
    Put(packet.data() + 8, frame_id + random_() % 3, 8);
    Put(packet.data() + 16, random_() % 4 == 0 ? random_() : random_() % 80, 4);
    if (random_() % 2 == 0) packet[23] = random_() % 2 == 0 ? 0x0a : 0x01;  // a sound payload type
    const std::size_t size = random_() % 5 == 0 ? random_() % 24 : 20 + random_() % 1480;
    sendto(socket_, packet.data(), size, 0, reinterpret_cast<sockaddr*>(&target_), sizeof(target_));
  }

 private:
  static sockaddr_in Inet(const std::string& address, int port) {
    sockaddr_in inet = {};
    inet.sin_family = AF_INET;
    inet.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, address.c_str(), &inet.sin_addr);
    return inet;
  }
  static void Put(std::uint8_t* to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      to[i] = static_cast<std::uint8_t>(value >> (8 * (bytes - 1 - i)));
    }
  }

  int socket_;
  sockaddr_in target_;
  std::mt19937 random_;
};

/// A camera that streams to Aravis directly.
class HostileStream : public testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    CameraTarget target;
    target.id = LoopbackAddress();
    camera_ = AravisCamera::Open(target, "", &reason);
    ASSERT_NE(camera_, nullptr) << reason;
    ASSERT_TRUE(camera_->TakeControl());
    setup_ = ConfigureDevice(camera_->features(), {});
    ASSERT_TRUE(camera_->Start({}, 0).ok());
    ASSERT_TRUE(camera_->guarded());
  }
  std::string StreamAddress() { return LocalAddressTowards(LoopbackAddress()).value_or(""); }

  SimulatedCamera simulated_{LoopbackAddress()};
  std::unique_ptr<AravisCamera> camera_;
  DeviceSetup setup_;
};

TEST_F(HostileStream, StrangersPacketsNeverReachIt) {
  Babbler babbler("127.0.0.77", StreamAddress(), camera_->port(), 1);
  const FrameDecoder decoder(setup_, {});
  SourceFrame frame;
  std::uint64_t id = 1;
  for (int good = 0; good < 60;) {
    for (int i = 0; i < 100; ++i) babbler.Send(id);
    while (auto buffer = camera_->Pop(0.001)) {
      ASSERT_TRUE(buffer->complete());
      ASSERT_TRUE(decoder.Decode(buffer->ReadParts(setup_.codes), &frame).ok());
      const auto wanted = PatternFrame(simulated_.camera(), frame.images.depth.values[0]);
      ASSERT_EQ(frame.images.depth, wanted.depth);
      id = buffer->frame_id();
      ++good;
    }
  }
}

TEST_F(HostileStream, NonsenseInTheCamerasOwnNameIsSurvived) {
  constexpr unsigned kSeed = 31;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Babbler babbler(LoopbackAddress(), StreamAddress(), camera_->port(), kSeed);
  const FrameDecoder decoder(setup_, {});
  SourceFrame frame;
  std::uint64_t id = 1;
  for (int round = 0; round < 1000; ++round) {
    for (int i = 0; i < 50; ++i) babbler.Send(id);
    while (auto buffer = camera_->Pop(0.0005)) {
      if (buffer->frame_id() < 1'000'000) id = buffer->frame_id();
      if (buffer->complete()) (void)decoder.Decode(buffer->ReadParts(setup_.codes), &frame);
    }
  }
}

TEST(StreamFilter, LetsThroughWhatACameraSendsAndNothingElse) {
  const int receiver = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own = {};
  own.sin_family = AF_INET;
  inet_pton(AF_INET, LoopbackAddress().c_str(), &own.sin_addr);
  ASSERT_EQ(bind(receiver, reinterpret_cast<sockaddr*>(&own), sizeof(own)), 0);
  socklen_t size = sizeof(own);
  getsockname(receiver, reinterpret_cast<sockaddr*>(&own), &size);
  const int port = ntohs(own.sin_port);
  ASSERT_TRUE(GuardStreamSocket(LoopbackAddress(), port, LoopbackAddress(), 100));
  EXPECT_FALSE(GuardStreamSocket("127.0.0.1", port, LoopbackAddress(), 100));
  const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in from = own;
  from.sin_port = 0;
  ASSERT_EQ(bind(sender, reinterpret_cast<sockaddr*>(&from), sizeof(from)), 0);
  const auto arrives = [&](std::vector<std::uint8_t> packet) {
    sendto(sender, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&own), sizeof(own));
    std::array<std::uint8_t, 64> got;
    return recv(receiver, got.data(), got.size(), MSG_DONTWAIT) > 0;
  };
  const auto extended = [](std::uint8_t type, std::uint8_t id) {
    std::vector<std::uint8_t> packet(20, 0);
    packet[4] = static_cast<std::uint8_t>(0x80 | type);
    packet[19] = id;
    return packet;
  };
  for (const std::uint8_t type : std::array<std::uint8_t, 4>{1, 2, 3, 7}) {
    EXPECT_TRUE(arrives(extended(type, 100))) << int{type};
    EXPECT_FALSE(arrives(extended(type, 101))) << int{type};
    EXPECT_TRUE(arrives({0, 0, 0, 1, type, 0, 0, 100}));
    EXPECT_FALSE(arrives({0, 0, 0, 1, type, 0, 0, 101}));
    EXPECT_FALSE(arrives({0, 0, 0, 1, type, 1, 0, 0}));
  }
  for (const std::uint8_t type : std::array<std::uint8_t, 6>{0, 4, 5, 6, 8, 127})
    EXPECT_FALSE(arrives(extended(type, 0)));
  EXPECT_FALSE(arrives({}));
  EXPECT_FALSE(arrives({0, 0, 0, 1, 3, 0, 0}));
  std::vector<std::uint8_t> cut = extended(3, 0);
  cut.pop_back();
  EXPECT_FALSE(arrives(cut));
  close(sender);
  close(receiver);
}

TEST(StreamFilter, NumbersReachAsFarAsThePayload) {
  EXPECT_EQ(LastPacketId(0, 1500), kSparePackets);
  EXPECT_EQ(LastPacketId(1452 * 1000, 1500), 1000 + kSparePackets);
}

}  // namespace
}  // namespace palpate::capture
