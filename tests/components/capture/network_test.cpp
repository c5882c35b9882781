// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/capture/aravis/listed_device.hpp"
#include "components/capture/network/control_probe.hpp"
#include "components/capture/network/packet_size.hpp"
#include "components/capture/network/socket_report.hpp"

namespace palpate::capture {
namespace {

using testing::HasSubstr;
using Range = std::pair<std::int64_t, std::int64_t>;

TEST(PacketSize, IsTheLeastOfInterfaceCameraAndWish) {
  EXPECT_EQ(ChoosePacketSize_bytes(0, 1500, Range(220, 9000)), 1500);
  EXPECT_EQ(ChoosePacketSize_bytes(0, 9000, Range(220, 8192)), 8192);
  EXPECT_EQ(ChoosePacketSize_bytes(4000, 9000, Range(220, 8192)), 4000);
  EXPECT_EQ(ChoosePacketSize_bytes(9000, 1500, Range(220, 16404)), 1500);
  EXPECT_EQ(ChoosePacketSize_bytes(0, 65536, Range(220, 16404)), 16404);
  EXPECT_EQ(ChoosePacketSize_bytes(0, 1499, Range(220, 16404)), 1496);
}

TEST(PacketSize, UnknownOrAbsurdLimitsLeaveASizeThatEveryEthernetCarries) {
  EXPECT_EQ(ChoosePacketSize_bytes(0, std::nullopt, std::nullopt), 1500);
  EXPECT_EQ(ChoosePacketSize_bytes(0, 1500, Range(0, 0)), 1500);
  EXPECT_EQ(ChoosePacketSize_bytes(0, 1500, Range(-5, -1)), 1500);
  EXPECT_EQ(ChoosePacketSize_bytes(0, 0, Range(220, 9000)), kLeastPacketSize_bytes);
}

TEST(PacketSize, TheLoopbackInterfaceIsFoundByItsAddress) {
  EXPECT_EQ(LocalAddressTowards("127.0.0.1"), "127.0.0.1");
  EXPECT_GE(InterfaceMtu_bytes("127.0.0.1").value_or(0), 1500);
  EXPECT_FALSE(InterfaceMtu_bytes("203.0.113.7").has_value());
  EXPECT_FALSE(LocalAddressTowards("no address").has_value());
  EXPECT_TRUE(IsIpv4Address("10.0.0.1"));
  EXPECT_FALSE(IsIpv4Address("10.0.0"));
  EXPECT_FALSE(IsIpv4Address("Palpate-VC000001"));
}

constexpr std::string_view kProcNetUdp =
    "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode ref pointer drops\n"
    "  467: 00000000:D2F0 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "21 2 0000000000000000 17\n"
    " 1467: 0100007F:D2F0 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "22 2 0000000000000000 5\n"
    "  468: 00000000:0F74 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "23 2 0000000000000000 99\n";

TEST(SocketReport, DropsAreThoseOfThePort) {
  EXPECT_EQ(DropsOfPort(kProcNetUdp, 0xD2F0), 22u);
  EXPECT_EQ(DropsOfPort(kProcNetUdp, 0x0F74), 99u);
  EXPECT_FALSE(DropsOfPort(kProcNetUdp, 1).has_value());
  EXPECT_FALSE(DropsOfPort("", 1).has_value());
  EXPECT_FALSE(DropsOfPort("a b c:zz d e f g h i j k l m\n1 2 3:4 5 6 7 8 9 10 11 12 13 -5\n", 4)
                   .has_value());
}

TEST(SocketReport, AStockKernelIsSaidWithTheMendingCommand) {
  const std::string advice = ReceiveBufferAdvice(16777216, 212992);
  EXPECT_THAT(advice, HasSubstr("212992"));
  EXPECT_THAT(advice, HasSubstr("sudo sysctl -w net.core.rmem_max=16777216"));
  EXPECT_EQ(ReceiveBufferAdvice(16777216, 16777216), "");
  EXPECT_EQ(ReceiveBufferAdvice(16777216, 4194304), "");
  EXPECT_EQ(ReceiveBufferAdvice(212992, 212992), "");
}

TEST(SocketReport, TheKernelGrantsSomethingAndNoMoreThanAsked) {
  const auto granted = GrantedReceiveBuffer_bytes(65536);
  ASSERT_TRUE(granted.has_value());
  EXPECT_EQ(*granted, 65536);
}

TEST(ListedDevice, IsMeantByAnyOfItsNames) {
  const ListedDevice device = {"Palpate-Virtual RGB-D-VC000001",
                               "00:11:22:33:44:55",
                               "Palpate",
                               "Virtual RGB-D",
                               "VC000001",
                               "10.0.0.2",
                               "GigEVision"};
  for (const char* id : {"Palpate-VC000001", "VC000001", "00:11:22:33:44:55", "10.0.0.2",
                         "Palpate-Virtual RGB-D-VC000001"}) {
    EXPECT_TRUE(IsMeant(id, device)) << id;
  }
  for (const char* id : {"", "Palpate", "VC00000", "Palpate-VC000002"}) {
    EXPECT_FALSE(IsMeant(id, device)) << id;
  }
}

TEST(ControlProbe, SilenceWhereNobodyListens) {
  EXPECT_EQ(ProbeControl("127.0.0.99", 0.05), Probe::kSilent);
  EXPECT_EQ(ProbeControl("no address", 0.05), Probe::kSilent);
}

}  // namespace
}  // namespace palpate::capture
