// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace palpate::capture {

inline constexpr int kSafePacketSize_bytes = 1500;  ///< what every Ethernet carries
inline constexpr int kLeastPacketSize_bytes = 576;

/// The size of stream packets, IP and UDP headers included: the wanted one (0: the greatest), no
/// larger than the interface's MTU and than what the camera takes, a multiple of 4 and of the
/// camera's increment.
int ChoosePacketSize_bytes(int wanted_bytes, std::optional<int> mtu_bytes,
                           std::optional<std::pair<std::int64_t, std::int64_t>> camera_range);

/// IPv4 of the own interface from which `address` is reached; nothing where there is no route, or
/// `address` is no IPv4 address.
std::optional<std::string> LocalAddressTowards(const std::string& address);
/// MTU of the interface that has this IPv4 address; nothing where none has.
std::optional<int> InterfaceMtu_bytes(const std::string& local_address);
bool IsIpv4Address(const std::string& text);

}  // namespace palpate::capture
