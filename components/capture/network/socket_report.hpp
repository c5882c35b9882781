// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::capture {

/// What the kernel grants of a UDP receive buffer of `wanted_bytes` (net.core.rmem_max limits it);
/// nothing where there are no sockets.
std::optional<int> GrantedReceiveBuffer_bytes(int wanted_bytes);

/// Advice for a user whose kernel grants less than `least_bytes` of what was asked for, with
/// the command that fixes it; empty where all is well.
std::string ReceiveBufferAdvice(int wanted_bytes, int granted_bytes);

/// Datagrams that the kernel threw away at local UDP `port`, by the text of /proc/net/udp; nothing
/// where no socket has that port, or the text is of another kind.
std::optional<std::uint64_t> DropsOfPort(std::string_view proc_net_udp, int port);
/// The same of this machine now.
std::optional<std::uint64_t> SocketDrops(int port);

}  // namespace palpate::capture
