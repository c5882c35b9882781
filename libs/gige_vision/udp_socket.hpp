// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "libs/gige_vision/wire.hpp"

namespace palpate::gige_vision {

/// One end of a UDP conversation, IPv4 in host order.
struct Peer {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  bool operator==(const Peer&) const = default;
};

/// A network interface of this machine.
struct Interface {
  std::uint32_t address = 0;  ///< the one that was asked for
  std::uint32_t mask = 0;
  int index = 0;  ///< the kernel's
  std::uint32_t Broadcast() const { return address | ~mask; }
};

/// The interface that `address` ("192.168.1.10", "127.0.0.2") belongs to. Throws InputError where
/// that is no IPv4 address, RunError where no interface of this machine has it.
Interface FindInterface(const std::string& address);

std::string ToText(std::uint32_t address);

/// A UDP socket of this process; closed at the end of its life.
class UdpSocket {
 public:
  /// Port 0: any. `shared`: others may listen there too (broadcasts reach them all). Throws
  /// RunError with address, port and cause.
  UdpSocket(std::uint32_t address, std::uint16_t port, bool shared);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int descriptor() const { return descriptor_; }
  std::uint16_t port() const;
  /// A packet that the network will not take is lost, as UDP packets are.
  void Send(ByteView packet, const Peer& to) const;

  struct Received {
    Bytes packet;
    Peer from;
    int interface_index = 0;  ///< that it came in on
  };
  /// The next packet, if one is there; never waits.
  std::optional<Received> Receive() const;

 private:
  int descriptor_ = -1;
};

}  // namespace palpate::gige_vision
