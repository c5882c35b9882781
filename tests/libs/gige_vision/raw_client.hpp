// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "libs/gige_vision/protocol.hpp"
#include "libs/gige_vision/udp_socket.hpp"
#include "libs/gige_vision/wire.hpp"

namespace palpate::gige_vision {

/// An answer of a device as it stands on the wire.
struct RawAnswer {
  ErrorCode status = ErrorCode::kSuccess;
  std::uint16_t command = 0;
  std::uint16_t id = 0;
  Bytes body;
  std::uint32_t from = 0;  ///< IPv4
};

/// A stream packet as it stands on the wire.
struct RawStreamPacket {
  Bytes bytes;
  bool extended = false;
  std::uint16_t status = 0;
  std::uint16_t flags = 0;
  PacketFormat format = PacketFormat::kLeader;
  std::uint64_t block_id = 0;
  std::uint32_t packet_id = 0;
  std::size_t header_size = 0;
};

/// A client that sends given packets, valid or not: a control socket and a stream socket.
class RawClient {
 public:
  explicit RawClient(const std::string& device_address, const std::string& own = "127.0.0.1");

  /// Sends a command and waits for the answer to it (0: with the next request id), past answers to
  /// others. Nothing: none came.
  std::optional<RawAnswer> Ask(Command command, const Bytes& body, std::uint16_t id = 0,
                               std::uint8_t flags = kAcknowledgeFlag);
  void Send(const Bytes& packet, const std::string& to = "");
  std::optional<RawAnswer> Receive(double deadline_s = 5.0);

  ErrorCode Read(std::uint32_t address, std::uint32_t* value);
  std::uint32_t Read(std::uint32_t address);  ///< fails the test where it is refused
  ErrorCode Write(std::uint32_t address, std::uint32_t value);
  ErrorCode ReadMemory(std::uint32_t address, std::uint16_t size, Bytes* value);
  ErrorCode WriteMemory(std::uint32_t address, const Bytes& value);

  /// Takes control and lets the device stream to this client.
  void StartStream(std::uint32_t packet_size = 1500);
  std::optional<RawStreamPacket> NextPacket(double deadline_s = 5.0);
  /// Forgets what is there already.
  void DrainStream();
  void AskResend(std::uint64_t block_id, std::uint32_t first, std::uint32_t last, bool extended);

  static Bytes Packet(std::uint16_t command, const Bytes& body, std::uint16_t id,
                      std::uint8_t flags);
  std::uint32_t own_address() const { return own_.address; }
  std::uint16_t stream_port() const { return stream_.port(); }

 private:
  Interface own_;
  Peer device_;
  UdpSocket control_;
  UdpSocket stream_;
  std::uint16_t next_id_ = 1;
};

/// The address of a feature's register, read from the device's description.
std::uint32_t RegisterOf(const std::string& xml, const std::string& feature);

}  // namespace palpate::gige_vision
