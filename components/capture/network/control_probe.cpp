// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/network/control_probe.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>

#include "libs/gige_vision/protocol.hpp"

namespace palpate::capture {

namespace {

constexpr std::uint8_t kReadRegisterAnswer = 0x81;

/// GigE Vision 2.0, 14.3: key, acknowledge wanted, READREG, 4 bytes, request id, address.
std::array<std::uint8_t, 12> ReadPrivilegeCommand(std::uint16_t id) {
  return {0x42,
          0x01,
          0x00,
          0x80,
          0x00,
          0x04,
          static_cast<std::uint8_t>(id >> 8),
          static_cast<std::uint8_t>(id & 0xff),
          0x00,
          0x00,
          0x0a,
          0x00};
}

std::uint16_t NextRequestId() {
  static std::atomic<std::uint16_t> last{0x5000};
  const auto id = static_cast<std::uint16_t>(++last);
  return id == 0 ? std::uint16_t{1} : id;
}

Probe Judge(const std::uint8_t* answer, std::size_t size) {
  const bool success = answer[0] == 0 && answer[1] == 0;
  if (!success || size < 12 || answer[3] != kReadRegisterAnswer) return Probe::kControlled;
  const bool free = (answer[8] | answer[9] | answer[10] | answer[11]) == 0;
  return free ? Probe::kFree : Probe::kControlled;
}

Probe Ask(int handle, double timeout_s) {
  const std::uint16_t id = NextRequestId();
  const auto command = ReadPrivilegeCommand(id);
  if (send(handle, command.data(), command.size(), 0) != std::ssize(command)) return Probe::kSilent;
  pollfd waiting = {handle, POLLIN, 0};
  if (poll(&waiting, 1, static_cast<int>(timeout_s * 1e3)) <= 0) return Probe::kSilent;
  std::array<std::uint8_t, 64> answer;
  // A refusal by the host itself ("port unreachable") is an error here: no device is there.
  const ssize_t size = recv(handle, answer.data(), answer.size(), 0);
  const bool ours = size >= 8 && (answer[6] << 8 | answer[7]) == id;
  return ours ? Judge(answer.data(), static_cast<std::size_t>(size)) : Probe::kSilent;
}

}  // namespace

Probe ProbeControl(const std::string& address, double timeout_s) {
  sockaddr_in target = {};
  target.sin_family = AF_INET;
  target.sin_port = htons(gige_vision::kControlPort);
  if (inet_pton(AF_INET, address.c_str(), &target.sin_addr) != 1) return Probe::kSilent;
  const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (handle < 0) return Probe::kSilent;
  sockaddr generic;
  std::memcpy(&generic, &target, sizeof(generic));
  const Probe probe =
      connect(handle, &generic, sizeof(generic)) == 0 ? Ask(handle, timeout_s) : Probe::kSilent;
  close(handle);
  return probe;
}

}  // namespace palpate::capture
