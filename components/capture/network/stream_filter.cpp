// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/network/stream_filter.hpp"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace palpate::capture {

namespace {

constexpr std::uint32_t kUdpHeader = 8;  ///< the program sees datagrams from here on
constexpr std::uint32_t kSourceAddress = static_cast<std::uint32_t>(SKF_NET_OFF) + 12;
constexpr std::uint32_t kShortHeader = 8;  ///< GVSP with 16-bit block ids
constexpr std::uint32_t kLongHeader = 20;  ///< with 64-bit block ids
constexpr std::uint32_t kDataPacket = 3;   ///< after leader, 1, and trailer, 2
constexpr std::uint32_t kPartPacket = 7;   ///< data of a multi-part payload
constexpr int kHeaders_bytes = 48;         ///< IP, UDP, GVSP

/// Walks the open files of this process for the socket with this name.
int FindSocket(const std::string& local_address, int port) {
  in_addr wanted;
  if (inet_pton(AF_INET, local_address.c_str(), &wanted) != 1) return -1;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename().string();
    int handle = -1;
    if (std::from_chars(name.data(), name.data() + name.size(), handle).ec != std::errc()) continue;
    sockaddr_storage own = {};
    socklen_t size = sizeof(own);
    int type = 0;
    socklen_t type_size = sizeof(type);
    if (getsockname(handle, reinterpret_cast<sockaddr*>(&own), &size) != 0 ||
        own.ss_family != AF_INET ||
        getsockopt(handle, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM) {
      continue;
    }
    sockaddr_in inet;
    std::memcpy(&inet, &own, sizeof(inet));
    const bool here = inet.sin_addr.s_addr == wanted.s_addr || inet.sin_addr.s_addr == INADDR_ANY;
    if (here && ntohs(inet.sin_port) == port) return handle;
  }
  return -1;
}

constexpr sock_filter Load(std::uint16_t width, std::uint32_t at) {
  return {static_cast<std::uint16_t>(BPF_LD | width | BPF_ABS), 0, 0, at};
}
constexpr sock_filter Jump(std::uint16_t kind, std::uint32_t value, std::uint8_t if_true,
                           std::uint8_t if_false) {
  return {static_cast<std::uint16_t>(BPF_JMP | kind | BPF_K), if_true, if_false, value};
}

}  // namespace

std::uint32_t LastPacketId(std::int64_t payload_bytes, int packet_size_bytes) {
  const std::int64_t carried = std::max(1, packet_size_bytes - kHeaders_bytes);
  return static_cast<std::uint32_t>(payload_bytes / carried) + kSparePackets;
}

bool GuardStreamSocket(const std::string& local_address, int port,
                       const std::string& camera_address, std::uint32_t last_packet_id) {
  in_addr camera;
  const int handle = FindSocket(local_address, port);
  if (handle < 0 || inet_pton(AF_INET, camera_address.c_str(), &camera) != 1) return false;
  // Jumps count instructions from the next one on. A load of what is not there drops the datagram.
  std::array<sock_filter, 21> code = {{
      /* 0 */ Load(BPF_W, kSourceAddress),
      /* 1 */ Jump(BPF_JEQ, ntohl(camera.s_addr), 0, 18),
      /* 2 */ {BPF_LD | BPF_W | BPF_LEN, 0, 0, 0},
      /* 3 */ Jump(BPF_JGE, kUdpHeader + kShortHeader, 0, 16),
      /* 4 */ Load(BPF_B, kUdpHeader + 4),
      /* 5 */ {BPF_ALU | BPF_AND | BPF_K, 0, 0, 0x7f},
      /* 6 */ Jump(BPF_JEQ, kPartPacket, 2, 0),
      /* 7 */ Jump(BPF_JGT, kDataPacket, 12, 0),
      /* 8 */ Jump(BPF_JEQ, 0, 11, 0),
      /* 9 */ Load(BPF_B, kUdpHeader + 4),
      /* 10 */ Jump(BPF_JSET, 0x80, 0, 5),
      /* 11 */ {BPF_LD | BPF_W | BPF_LEN, 0, 0, 0},
      /* 12 */ Jump(BPF_JGE, kUdpHeader + kLongHeader, 0, 7),
      /* 13 */ Load(BPF_W, kUdpHeader + 16),
      /* 14 */ Jump(BPF_JGT, last_packet_id, 5, 4),
      /* 15 */ {BPF_RET | BPF_K, 0, 0, 0},
      /* 16 */ Load(BPF_W, kUdpHeader + 4),
      /* 17 */ {BPF_ALU | BPF_AND | BPF_K, 0, 0, 0x00ffffff},
      /* 18 */ Jump(BPF_JGT, last_packet_id, 1, 0),
      /* 19 */ {BPF_RET | BPF_K, 0, 0, UINT32_MAX},
      /* 20 */ {BPF_RET | BPF_K, 0, 0, 0},
  }};
  const sock_fprog program = {static_cast<unsigned short>(code.size()), code.data()};
  return setsockopt(handle, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program)) == 0;
}

}  // namespace palpate::capture
