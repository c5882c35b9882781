// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

namespace palpate::capture {

/// What a payload may have more packets than its size asks for: leader, trailer, the last packets
/// of parts.
inline constexpr std::uint32_t kSparePackets = 64;

/// Lets the kernel throw away, at this process's UDP socket of `local_address` and `port`, whatever
/// is not from `camera_address`, is no leader, trailer or data packet of GVSP, or numbers its
/// packets beyond `last_packet_id`: Aravis takes stream packets from any host and trusts their
/// numbers. False where there is no such socket, or the kernel refuses.
bool GuardStreamSocket(const std::string& local_address, int port,
                       const std::string& camera_address, std::uint32_t last_packet_id);

/// The greatest packet number that a payload can need.
std::uint32_t LastPacketId(std::int64_t payload_bytes, int packet_size_bytes);

}  // namespace palpate::capture
