// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/control_channel.hpp"

#include <algorithm>

namespace palpate::gige_vision {
namespace {

constexpr std::size_t kRemembered = 16;
constexpr std::int64_t kRememberedFor_ns = 5'000'000'000;
constexpr std::size_t kForceIpSize = 56;
constexpr std::int64_t kNsInMs = 1'000'000;

bool Writes(std::uint16_t command) {
  return command == static_cast<std::uint16_t>(Command::kWriteRegister) ||
         command == static_cast<std::uint16_t>(Command::kWriteMemory);
}

Bytes Acknowledgement(std::uint16_t command, std::uint16_t id, ErrorCode status,
                      const Bytes& body) {
  Bytes packet;
  Put16(&packet, static_cast<std::uint16_t>(status));
  Put16(&packet, static_cast<std::uint16_t>(command + 1));
  Put16(&packet, static_cast<std::uint16_t>(body.size()));
  Put16(&packet, id);
  packet.insert(packet.end(), body.begin(), body.end());
  return packet;
}

/// Of WRITEREG and WRITEMEM: how much was done.
Bytes Index(std::size_t done) {
  Bytes body;
  Put16(&body, 0);
  Put16(&body, static_cast<std::uint16_t>(done));
  return body;
}

}  // namespace

ControlChannel::ControlChannel(CameraState* state) : state_{state} {
  RegisterBank& bank = state_->bank();
  bank.OnRead(boot::kControlPrivilege, [this](Bytes* value) { *value = Encode32(privilege_); });
  bank.OnRead(boot::kPrimaryPort,
              [this](Bytes* value) { *value = Encode32(controller_ ? controller_->port : 0u); });
  bank.OnRead(boot::kPrimaryAddress,
              [this](Bytes* value) { *value = Encode32(controller_ ? controller_->address : 0u); });
}

Bytes ControlChannel::Answer(ByteView packet, const Peer& from, std::int64_t now_ns) {
  if (packet.size() < kControlHeaderSize || packet[0] != kCommandKey) return {};
  Request request;
  request.flags = packet[1];
  request.command = Get16(packet, 2);
  request.id = Get16(packet, 6);
  request.body = packet.subspan(kControlHeaderSize);
  request.from = from;
  if (request.id == 0) return {};  // the standard has no such request
  const bool wants_answer = (request.flags & kAcknowledgeFlag) != 0;
  if (Get16(packet, 4) != request.body.size()) {
    return wants_answer
               ? Acknowledgement(request.command, request.id, ErrorCode::kInvalidHeader, {})
               : Bytes{};
  }
  CheckHeartbeat(now_ns);
  if (controller_ == from) heard_ns_ = now_ns;
  for (const Answered& before : answered_) {
    const bool recent = now_ns - before.when_ns < kRememberedFor_ns;
    if (recent && before.from == from && std::ranges::equal(before.packet, packet)) {
      return before.answer;  // the answer was lost: not executed again
    }
  }
  const std::optional<Reply> reply = Execute(request);
  if (controller_ == from) heard_ns_ = now_ns;
  if (!reply || !wants_answer) return {};
  Bytes answer = Acknowledgement(request.command, request.id, reply->status, reply->body);
  if (Writes(request.command)) {
    answered_.push_back({from, Bytes(packet.begin(), packet.end()), answer, now_ns});
    if (answered_.size() > kRemembered) answered_.pop_front();
  }
  return answer;
}

std::optional<ControlChannel::Reply> ControlChannel::Execute(const Request& request) {
  switch (static_cast<Command>(request.command)) {
    case Command::kDiscovery: return Discovery();
    case Command::kForceIp: return ForceIp(request);
    case Command::kPacketResend: Resend(request); return std::nullopt;  // answered by the packets
    case Command::kReadRegister: return ReadRegisters(request);
    case Command::kWriteRegister: return WriteRegisters(request);
    case Command::kReadMemory: return ReadMemory(request);
    case Command::kWriteMemory: return WriteMemory(request);
  }
  return Reply{ErrorCode::kNotImplemented, {}};
}

ControlChannel::Reply ControlChannel::Discovery() const {
  return {ErrorCode::kSuccess, state_->bank().Bootstrap(kDiscoverySize)};
}

/// Our address is the host's: we keep it, and say so to who asks for another.
std::optional<ControlChannel::Reply> ControlChannel::ForceIp(const Request& request) const {
  if (request.body.size() != kForceIpSize) return Reply{ErrorCode::kInvalidHeader, {}};
  const std::uint64_t mac = Get64(request.body, 0) & 0xffff'ffff'ffff;
  if (mac != state_->identity().mac) return std::nullopt;  // meant for another device
  const std::uint32_t address = Get32(request.body, 20);
  if (address == 0 || address == state_->identity().address) return Reply{};
  return Reply{controlled() ? ErrorCode::kAccessDenied : ErrorCode::kInvalidParameter, {}};
}

bool ControlChannel::MayRead(const Peer& from) const {
  return (privilege_ & kPrivilegeExclusive) == 0 || controller_ == from;
}

ControlChannel::Reply ControlChannel::ReadRegisters(const Request& request) const {
  Reply reply;
  if (request.body.empty() || request.body.size() % 4 != 0 ||
      request.body.size() > kMaxReadSize + 4) {
    return {ErrorCode::kInvalidHeader, {}};
  }
  if (!MayRead(request.from)) return {ErrorCode::kAccessDenied, {}};
  for (std::size_t at = 0; at < request.body.size(); at += 4) {
    Bytes value;
    reply.status = state_->bank().Read(Get32(request.body, at), 4, &value);
    if (reply.status != ErrorCode::kSuccess) break;
    reply.body.insert(reply.body.end(), value.begin(), value.end());
  }
  return reply;
}

ControlChannel::Reply ControlChannel::WriteRegisters(const Request& request) {
  if (request.body.empty() || request.body.size() % 8 != 0) {
    return {ErrorCode::kInvalidHeader, {}};
  }
  std::size_t done = 0;
  ErrorCode status = ErrorCode::kSuccess;
  while (8 * done < request.body.size()) {
    const std::uint32_t address = Get32(request.body, 8 * done);
    status = Write(address, request.body.subspan(8 * done + 4, 4), request.from);
    if (status != ErrorCode::kSuccess) break;
    ++done;
  }
  return {status, Index(done)};
}

ControlChannel::Reply ControlChannel::ReadMemory(const Request& request) const {
  if (request.body.size() != 8) return {ErrorCode::kInvalidHeader, {}};
  const std::uint32_t address = Get32(request.body, 0);
  const std::size_t size = Get16(request.body, 6);
  if (!MayRead(request.from)) return {ErrorCode::kAccessDenied, {}};
  if (size == 0 || size > kMaxReadSize) return {ErrorCode::kInvalidParameter, {}};
  Bytes value;
  const ErrorCode status = state_->bank().Read(address, size, &value);
  if (status != ErrorCode::kSuccess) return {status, {}};
  Reply reply;
  Put32(&reply.body, address);
  reply.body.insert(reply.body.end(), value.begin(), value.end());
  return reply;
}

ControlChannel::Reply ControlChannel::WriteMemory(const Request& request) {
  if (request.body.size() <= 4) return {ErrorCode::kInvalidHeader, {}};
  const ByteView value = request.body.subspan(4);
  const ErrorCode status = Write(Get32(request.body, 0), value, request.from);
  return {status, Index(status == ErrorCode::kSuccess ? value.size() : 0)};
}

ErrorCode ControlChannel::Write(std::uint32_t address, ByteView value, const Peer& from) {
  if (address == boot::kControlPrivilege && value.size() == 4) {
    return WritePrivilege(Get32(value, 0), from);
  }
  if (controller_ != from) return ErrorCode::kAccessDenied;
  return state_->bank().Write(address, value);
}

ErrorCode ControlChannel::WritePrivilege(std::uint32_t value, const Peer& from) {
  if (controller_ && controller_ != from) return ErrorCode::kAccessDenied;
  if ((value & ~(kPrivilegeControl | kPrivilegeExclusive)) != 0) {
    return ErrorCode::kInvalidParameter;  // no switch-over
  }
  if (value == 0) {
    if (controller_) Release();
  } else {
    controller_ = from;
    privilege_ = value;
  }
  return ErrorCode::kSuccess;
}

void ControlChannel::Release() {
  controller_.reset();
  privilege_ = 0;
  state_->ForgetClient();
}

std::optional<std::int64_t> ControlChannel::Deadline_ns() const {
  const RegisterBank& bank = state_->bank();
  const bool watched = (bank.Get(boot::kControlConfiguration) & kHeartbeatDisable) == 0;
  if (!controller_ || !watched) return std::nullopt;
  return heard_ns_ + bank.Get(boot::kHeartbeatTimeout) * kNsInMs;
}

void ControlChannel::CheckHeartbeat(std::int64_t now_ns) {
  const std::optional<std::int64_t> deadline_ns = Deadline_ns();
  if (deadline_ns && now_ns >= *deadline_ns) Release();
}

void ControlChannel::Resend(const Request& request) const {
  const bool extended = (request.flags & kExtendedIdFlag) != 0;
  if (request.body.size() < (extended ? 20u : 12u) || !on_resend) return;
  if (Get16(request.body, 0) != 0) return;  // there is one stream channel
  // Comes from the client's stream port: its address must be the controller's, its port need not.
  if (!controller_ || controller_->address != request.from.address) return;
  ResendRequest asked;
  asked.extended_ids = extended;
  asked.block_id = extended ? Get64(request.body, 12) : Get16(request.body, 2);
  const std::uint32_t mask = extended ? 0xffff'ffff : 0x00ff'ffff;
  asked.first_packet = Get32(request.body, 4) & mask;
  asked.last_packet = Get32(request.body, 8) & mask;
  on_resend(asked);
}

}  // namespace palpate::gige_vision
