// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/motion_capture/natnet_packet.hpp"

#include <gmock/gmock.h>

#include <random>
#include <string>

#include "components/motion_capture/captured_markers.hpp"
#include "libs/core/error.hpp"
#include "tests/components/motion_capture/natnet_writer.hpp"

namespace palpate::motion_capture {
namespace {

using testing::HasSubstr;

Status Parse(const Bytes& bytes, const NatNetVersion& version, NatNetFrame* frame) {
  return ParseNatNetFrame(bytes.data(), bytes.size(), version, frame);
}

TEST(NatNetPacket, SetsAndUnlabelledMarkersOfBothLayoutsAreRead) {
  for (const NatNetVersion version :
       {NatNetVersion{3, 1}, NatNetVersion{4, 0}, NatNetVersion{4, 1}}) {
    NatNetFrame frame;
    const Status status = Parse(NatNetWriter(version).Frame(SampleFrame(42)), version, &frame);
    ASSERT_TRUE(status.ok()) << version.major << "." << version.minor << status.message();
    EXPECT_EQ(frame.number, 42);
    ASSERT_EQ(frame.sets.size(), 3u);
    EXPECT_EQ(frame.sets[0].name, "Tip");
    EXPECT_EQ(frame.sets[0].positions_m.at(0), Eigen::Vector3f(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(frame.sets[1].positions_m.size(), 1u);
    ASSERT_EQ(frame.unlabelled_m.size(), 1u);
    EXPECT_EQ(frame.unlabelled_m[0].z(), 3.0f * 0.3f);
  }
}

/// Written byte by byte after the SDK's description: frame 5, one set "A" of one marker at (1, 2,
/// 4).
TEST(NatNetPacket, AFrameWrittenByHandIsRead) {
  const Bytes bytes{7, 0,    38,  0, 5,    0,    0, 0, 1, 0, 0,    0,    18, 0,
                    0, 0,    'A', 0, 1,    0,    0, 0, 0, 0, 0x80, 0x3F, 0,  0,
                    0, 0x40, 0,   0, 0x80, 0x40, 0, 0, 0, 0, 0,    0,    0,  0};
  NatNetFrame frame;
  const Status status = Parse(bytes, {4, 1}, &frame);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(frame.number, 5);
  ASSERT_EQ(frame.sets.size(), 1u);
  EXPECT_EQ(frame.sets[0].positions_m.at(0), Eigen::Vector3f(1.0f, 2.0f, 4.0f));
}

TEST(NatNetPacket, OtherMessagesAreNoFrames) {
  const Bytes model = NatNetWriter({4, 1}).Message(5);
  EXPECT_FALSE(IsNatNetFrame(model.data(), model.size()));
  NatNetFrame frame;
  EXPECT_EQ(Parse(model, {4, 1}, &frame).code(), StatusCode::kInvalidInput);
  EXPECT_EQ(Parse({}, {4, 1}, &frame).code(), StatusCode::kInvalidInput);
  EXPECT_EQ(Parse({7}, {4, 1}, &frame).code(), StatusCode::kInvalidInput);
}

TEST(NatNetPacket, AFrameThatIsCutAnywhereIsRefusedAndNothingIsSet) {
  const Bytes whole = NatNetWriter({4, 1}).Frame(SampleFrame(42));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    NatNetFrame frame;
    EXPECT_FALSE(
        Parse({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, {4, 1}, &frame)
            .ok())
        << size;
    EXPECT_TRUE(frame.sets.empty());
  }
}

TEST(NatNetPacket, CountsBeyondTheDatagramAreRefused) {
  const Bytes whole = NatNetWriter({4, 1}).Frame(SampleFrame(42));
  std::mt19937 random(3);
  std::uniform_int_distribution<int> byte(0, 255);
  for (std::size_t i = 4; i < whole.size(); ++i) {
    for (int k = 0; k < 16; ++k) {
      Bytes changed = whole;
      changed[i] = static_cast<std::uint8_t>(byte(random));
      NatNetFrame frame;
      (void)Parse(changed, {4, 1}, &frame);  // reads nothing beyond the datagram
      EXPECT_LE(frame.sets.size(), whole.size());
    }
  }
  Bytes huge = whole;
  huge[8] = huge[9] = huge[10] = 0xFF;  // the number of sets
  NatNetFrame frame;
  EXPECT_THAT(Parse(huge, {4, 1}, &frame).message(), HasSubstr("natnet_version"));
}

TEST(NatNetPacket, VersionsAreReadStrictly) {
  EXPECT_EQ(ParseNatNetVersion("3.1").major, 3);
  EXPECT_EQ(ParseNatNetVersion("4.2").minor, 2);
  for (const char* text : {"", "4", "2.9", "4.x", "4.1 ", "4.-1"}) {
    EXPECT_THROW(ParseNatNetVersion(text), InputError) << text;
  }
}

TEST(MarkerMap, MarkersAreNamedAndMappedToTheRobot) {
  const Eigen::Isometry3d T_robot_mocap(Eigen::Translation3d(1.0, 0.0, 0.0));
  const auto markers = MarkerMap(T_robot_mocap, {"Base-1:=m1"}, true).Map(SampleFrame(1));
  ASSERT_EQ(markers.size(), 4u);
  EXPECT_EQ(markers[0].name, "Tip-1");
  ASSERT_TRUE(markers[0].position_m);
  EXPECT_TRUE(markers[0].position_m->isApprox(Eigen::Vector3d(1.1, 0.2, 0.3), 1e-6));
  EXPECT_EQ(markers[1].name, "Tip-2");
  EXPECT_FALSE(markers[1].position_m);
  EXPECT_EQ(markers[2].name, "m1");
  EXPECT_EQ(markers[3].name, "");
  EXPECT_EQ(MarkerMap(T_robot_mocap, {}, false).Map(SampleFrame(1)).size(), 3u);
}

TEST(MarkerMap, RulesThatAreNoneAreRefused) {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  for (const std::string rule : {"a=b", ":=b", "a:="}) {
    EXPECT_THROW(MarkerMap(identity, {rule}, false), InputError) << rule;
  }
  EXPECT_THROW(MarkerMap(identity, {"a:=b", "a:=c"}, false), InputError);
}

}  // namespace
}  // namespace palpate::motion_capture
