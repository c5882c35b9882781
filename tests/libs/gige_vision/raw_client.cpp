// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/gige_vision/raw_client.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

namespace palpate::gige_vision {
namespace {

bool Wait(const UdpSocket& socket, double deadline_s) {
  pollfd waiting{socket.descriptor(), POLLIN, 0};
  return poll(&waiting, 1, static_cast<int>(deadline_s * 1e3)) > 0;
}

}  // namespace

RawClient::RawClient(const std::string& device_address, const std::string& own)
    : own_{FindInterface(own)},
      device_{FindInterface(device_address).address, kControlPort},
      control_{own_.address, 0, false},
      stream_{own_.address, 0, false} {
  const int size_B = 4 << 20;
  setsockopt(stream_.descriptor(), SOL_SOCKET, SO_RCVBUF, &size_B, sizeof size_B);
}

Bytes RawClient::Packet(std::uint16_t command, const Bytes& body, std::uint16_t id,
                        std::uint8_t flags) {
  Bytes packet = {kCommandKey, flags};
  Put16(&packet, command);
  Put16(&packet, static_cast<std::uint16_t>(body.size()));
  Put16(&packet, id);
  packet.insert(packet.end(), body.begin(), body.end());
  return packet;
}

void RawClient::Send(const Bytes& packet, const std::string& to) {
  in_addr there{};
  if (!to.empty()) inet_pton(AF_INET, to.c_str(), &there);
  control_.Send(packet, to.empty() ? device_ : Peer{ntohl(there.s_addr), kControlPort});
}

std::optional<RawAnswer> RawClient::Receive(double deadline_s) {
  if (!Wait(control_, deadline_s)) return std::nullopt;
  const auto received = control_.Receive();
  if (!received || received->packet.size() < kControlHeaderSize) return std::nullopt;
  RawAnswer answer;
  answer.status = static_cast<ErrorCode>(Get16(received->packet, 0));
  answer.command = Get16(received->packet, 2);
  answer.id = Get16(received->packet, 6);
  answer.body.assign(received->packet.begin() + kControlHeaderSize, received->packet.end());
  answer.from = received->from.address;
  EXPECT_EQ(Get16(received->packet, 4), answer.body.size());
  return answer;
}

std::optional<RawAnswer> RawClient::Ask(Command command, const Bytes& body, std::uint16_t id,
                                        std::uint8_t flags) {
  if (id == 0) id = next_id_++;
  Send(Packet(static_cast<std::uint16_t>(command), body, id, flags));
  auto answer = Receive();
  while (answer && answer->id != id) answer = Receive();
  if (answer) {
    EXPECT_EQ(answer->command, static_cast<std::uint16_t>(command) + 1);
  }
  return answer;
}

ErrorCode RawClient::Read(std::uint32_t address, std::uint32_t* value) {
  const auto answer = Ask(Command::kReadRegister, Encode32(address));
  if (!answer) return ErrorCode::kInvalidHeader;
  if (answer->status == ErrorCode::kSuccess) *value = Get32(answer->body, 0);
  return answer->status;
}

std::uint32_t RawClient::Read(std::uint32_t address) {
  std::uint32_t value = 0;
  EXPECT_EQ(Read(address, &value), ErrorCode::kSuccess) << address;
  return value;
}

ErrorCode RawClient::Write(std::uint32_t address, std::uint32_t value) {
  Bytes body = Encode32(address);
  Put32(&body, value);
  const auto answer = Ask(Command::kWriteRegister, body);
  return answer ? answer->status : ErrorCode::kInvalidHeader;
}

ErrorCode RawClient::ReadMemory(std::uint32_t address, std::uint16_t size, Bytes* value) {
  Bytes body = Encode32(address);
  Put32(&body, size);
  const auto answer = Ask(Command::kReadMemory, body);
  if (!answer) return ErrorCode::kInvalidHeader;
  if (answer->status == ErrorCode::kSuccess)
    value->assign(answer->body.begin() + 4, answer->body.end());
  return answer->status;
}

ErrorCode RawClient::WriteMemory(std::uint32_t address, const Bytes& value) {
  Bytes body = Encode32(address);
  body.insert(body.end(), value.begin(), value.end());
  const auto answer = Ask(Command::kWriteMemory, body);
  return answer ? answer->status : ErrorCode::kInvalidHeader;
}

void RawClient::StartStream(std::uint32_t packet_size) {
  EXPECT_EQ(Write(boot::kControlPrivilege, kPrivilegeControl), ErrorCode::kSuccess);
  EXPECT_EQ(Write(boot::kStreamAddress, own_.address), ErrorCode::kSuccess);
  EXPECT_EQ(Write(boot::kStreamPacketSize, packet_size), ErrorCode::kSuccess);
  EXPECT_EQ(Write(boot::kStreamPort, stream_.port()), ErrorCode::kSuccess);
}

std::optional<RawStreamPacket> RawClient::NextPacket(double deadline_s) {
  if (!Wait(stream_, deadline_s)) return std::nullopt;
  auto received = stream_.Receive();
  if (!received || received->packet.size() < 8) return std::nullopt;
  RawStreamPacket packet;
  packet.bytes = std::move(received->packet);
  packet.status = Get16(packet.bytes, 0);
  const std::uint32_t infos = Get32(packet.bytes, 4);
  packet.extended = (infos & 0x8000'0000) != 0;
  packet.format = static_cast<PacketFormat>((infos >> 24) & 0x7f);
  packet.flags = packet.extended ? Get16(packet.bytes, 2) : 0;
  packet.block_id = packet.extended ? Get64(packet.bytes, 8) : Get16(packet.bytes, 2);
  packet.packet_id = packet.extended ? Get32(packet.bytes, 16) : infos & 0xff'ffff;
  packet.header_size = packet.extended ? 20 : 8;
  return packet;
}

void RawClient::DrainStream() {
  while (stream_.Receive()) {
  }
}

void RawClient::AskResend(std::uint64_t block_id, std::uint32_t first, std::uint32_t last,
                          bool extended) {
  Bytes body;
  Put16(&body, 0);
  Put16(&body, extended ? std::uint16_t{0} : static_cast<std::uint16_t>(block_id));
  Put32(&body, first);
  Put32(&body, last);
  if (extended) Put64(&body, block_id);
  stream_.Send(Packet(static_cast<std::uint16_t>(Command::kPacketResend), body, next_id_++,
                      extended ? kExtendedIdFlag : std::uint8_t{0}),
               device_);
}

std::uint32_t RegisterOf(const std::string& xml, const std::string& feature) {
  const std::size_t node = xml.find(" Name=\"" + feature + "Reg\"");
  EXPECT_NE(node, std::string::npos) << feature;
  const std::string open = "<Address>";
  const std::size_t at = xml.find(open, node) + open.size();
  return static_cast<std::uint32_t>(std::stoul(xml.substr(at, 10), nullptr, 16));
}

}  // namespace palpate::gige_vision
