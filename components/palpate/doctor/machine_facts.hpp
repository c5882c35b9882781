// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/palpate/doctor/machine_checks.hpp"
#include "libs/core/network_interfaces.hpp"

/// Facts about this computer, for the checks of `palpate doctor`. What cannot be read is absent.
namespace palpate::command {

ProcessorFacts ReadProcessor();
DiskFacts ReadDisk(const std::filesystem::path& folder);
/// `folder` may be empty.
SecurityFacts ReadSecurity(const std::filesystem::path& folder, bool is_on);
/// Takes a second.
std::vector<CameraFacts> FindCameras(const std::vector<std::string>& addresses,
                                     const std::vector<NetworkInterface>& interfaces);
/// Reads both files as the processes do; `calibration` may be empty.
Status CompareRobotFiles(const std::filesystem::path& robot,
                         const std::filesystem::path& calibration);

std::optional<std::int64_t> ReadReceiveBufferLimit_B();
int ReadFirstEphemeralPort();

/// The local address by which the kernel would send to `address` (IPv4 or a host's name); empty:
/// there is no route.
std::string LocalAddressTo(const std::string& address);

/// Whether a datagram to a multicast group, sent on the interface with this address, comes back
/// within `wait`.
bool MulticastComesBack(const std::string& local_address, std::chrono::milliseconds wait);

/// How many of the participant indices 0 to `limit` of a domain are taken on this host.
int CountUsedIndices(int domain_id, int limit);

}  // namespace palpate::command
