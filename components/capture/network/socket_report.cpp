// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/network/socket_report.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <vector>

namespace palpate::capture {

namespace {

constexpr int kEnoughBytes = 1 << 20;  ///< half a frame set of 848 x 480

/// Whole decimal or hexadecimal number; nothing for anything else.
std::optional<std::uint64_t> ParseWhole(const std::string& word, int base) {
  if (word.empty() || word.size() > 16) return std::nullopt;
  std::size_t used = 0;
  try {
    const std::uint64_t value = std::stoull(word, &used, base);
    return used == word.size() ? std::optional(value) : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::vector<std::string> Words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

}  // namespace

std::optional<int> GrantedReceiveBuffer_bytes(int wanted_bytes) {
  const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (handle < 0) return std::nullopt;
  int granted = 0;
  socklen_t size = sizeof(granted);
  const bool known =
      setsockopt(handle, SOL_SOCKET, SO_RCVBUF, &wanted_bytes, sizeof(wanted_bytes)) == 0 &&
      getsockopt(handle, SOL_SOCKET, SO_RCVBUF, &granted, &size) == 0;
  close(handle);
  // The kernel counts twice the bytes, for its own book-keeping (socket(7)).
  return known ? std::optional(granted / 2) : std::nullopt;
}

std::string ReceiveBufferAdvice(int wanted_bytes, int granted_bytes) {
  if (granted_bytes >= wanted_bytes || granted_bytes >= kEnoughBytes) return "";
  const std::string wanted = std::to_string(wanted_bytes);
  return "the kernel grants a receive buffer of " + std::to_string(granted_bytes) +
         " bytes only (" + wanted +
         " wanted): frames will be lost in bursts; fix with: sudo sysctl -w "
         "net.core.rmem_max=" +
         wanted;
}

std::optional<std::uint64_t> DropsOfPort(std::string_view proc_net_udp, int port) {
  // Columns (proc(5)): sl local_address rem_address st ... inode ref pointer drops.
  std::istringstream lines{std::string(proc_net_udp)};
  std::optional<std::uint64_t> drops;
  for (std::string line; std::getline(lines, line);) {
    const auto words = Words(line);
    if (words.size() < 13) continue;
    const std::size_t colon = words[1].rfind(':');
    if (colon == std::string::npos) continue;
    const auto local_port = ParseWhole(words[1].substr(colon + 1), 16);
    const auto dropped = ParseWhole(words[12], 10);
    if (!local_port || !dropped || *local_port != static_cast<std::uint64_t>(port)) continue;
    drops = drops.value_or(0) + *dropped;
  }
  return drops;
}

std::optional<std::uint64_t> SocketDrops(int port) {
  std::ifstream file("/proc/net/udp");
  std::ostringstream text;
  text << file.rdbuf();
  return DropsOfPort(text.str(), port);
}

}  // namespace palpate::capture
