// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "libs/gige_vision/camera_state.hpp"
#include "libs/gige_vision/udp_socket.hpp"

namespace palpate::gige_vision {

/// Packets of a block that a client has missed; both ends are asked for.
struct ResendRequest {
  std::uint64_t block_id = 0;
  std::uint32_t first_packet = 0;
  std::uint32_t last_packet = 0;
  bool extended_ids = false;
};

/// GVCP: what the device answers to packets on its control port, and who may command it. No
/// sockets and no clock of its own; not thread-safe.
class ControlChannel {
 public:
  explicit ControlChannel(CameraState* state);

  /// The answer to one packet; empty: none is due. `now_ns` is monotonic.
  Bytes Answer(ByteView packet, const Peer& from, std::int64_t now_ns);
  /// Takes control away from a client that has been silent for longer than the timeout.
  void CheckHeartbeat(std::int64_t now_ns);
  /// When CheckHeartbeat is due next; nothing: no client has control.
  std::optional<std::int64_t> Deadline_ns() const;
  bool controlled() const { return controller_.has_value(); }

  std::function<void(const ResendRequest&)> on_resend;

 private:
  struct Request {
    std::uint16_t command = 0;
    std::uint8_t flags = 0;
    std::uint16_t id = 0;
    ByteView body;
    Peer from;
  };
  struct Reply {
    ErrorCode status = ErrorCode::kSuccess;
    Bytes body;
  };
  struct Answered {
    Peer from;
    Bytes packet;
    Bytes answer;
    std::int64_t when_ns = 0;
  };

  std::optional<Reply> Execute(const Request& request);
  Reply Discovery() const;
  std::optional<Reply> ForceIp(const Request& request) const;
  Reply ReadRegisters(const Request& request) const;
  Reply WriteRegisters(const Request& request);
  Reply ReadMemory(const Request& request) const;
  Reply WriteMemory(const Request& request);
  void Resend(const Request& request) const;
  ErrorCode Write(std::uint32_t address, ByteView value, const Peer& from);
  ErrorCode WritePrivilege(std::uint32_t value, const Peer& from);
  void Release();
  bool MayRead(const Peer& from) const;

  CameraState* state_;
  std::optional<Peer> controller_;
  std::uint32_t privilege_ = 0;
  std::int64_t heard_ns_ = 0;      ///< from the controller
  std::deque<Answered> answered_;  ///< writing commands, for repetitions of them
};

}  // namespace palpate::gige_vision
