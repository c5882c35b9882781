// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "libs/dds/entity.hpp"
#include "libs/dds/host.hpp"

namespace palpate::dds {

using Guid = std::array<std::uint8_t, 16>;

Guid ToArray(const dds_guid_t& guid);

/// What each of our participants says about its process in its user data, beside what ROS 2 reads
/// there.
struct ProcessIdentity {
  Host host;
  std::string program;
  std::int64_t process_id = 0;
  std::string process_namespace;  ///< in which the number holds
  std::int64_t start_ns = 0;      ///< since 1970, by its clock
  std::string messages;           ///< MessagesHash() of its build
};

/// This process.
ProcessIdentity ThisProcess();

/// 8 hex digits of the structure of all our messages: processes with unequal ones do not
/// understand each other.
const std::string& MessagesHash();

/// "palpate=...;", and back; nullopt for what another program says.
std::string ToUserData(const ProcessIdentity& process);
std::optional<ProcessIdentity> FromUserData(std::string_view user_data);

/// Whether that process may still run: false only where it was on this machine and has ended, so
/// that DDS has merely not noticed yet.
bool MayRun(const ProcessIdentity& process);

/// The participants of a domain, with the process of each that tells.
class Peers {
 public:
  /// Throws RunError where DDS refuses.
  explicit Peers(dds_entity_t participant);

  /// Takes what has changed.
  void Update();

  /// Of those that are there now, the own one too; empty: of another program.
  const std::map<Guid, std::optional<ProcessIdentity>>& all() const { return all_; }

 private:
  Entity reader_;
  std::map<Guid, std::optional<ProcessIdentity>> all_;
};

}  // namespace palpate::dds
