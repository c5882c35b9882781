// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libs/security/certificates.hpp"

namespace palpate::security {

/// Which topics an identity may write and read: DDS names ("rt/forces"), `*` for any characters.
struct AccessRights {
  std::vector<std::string> write;
  std::vector<std::string> read;

  bool operator==(const AccessRights&) const = default;
};

/// Domains above cannot be secured by Cyclone DDS.
inline constexpr std::uint32_t kLastSecuredDomain = 230;

/// The rules of a whole domain (DDS Security 1.1, section 9.4.1.2): nobody takes part without an
/// identity; discovery, liveliness and messages are encrypted; each packet is authenticated; each
/// topic is under access control. A message is encrypted as a whole: its fragments one by one
/// (metadata_protection_kind) would cost many times more.
std::string GovernanceXml();

/// What the identity may do in every domain up to kLastSecuredDomain (DDS Security 1.1,
/// section 9.4.1.3). All else is denied.
std::string PermissionsXml(const std::string& identity, const AccessRights& rights,
                           const Period& valid);

/// The rights in a text of PermissionsXml(), each list sorted.
AccessRights ReadRights(const std::string& permissions_xml);

}  // namespace palpate::security
