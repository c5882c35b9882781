// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "libs/dds/entity.hpp"

namespace palpate::dds {

/// Who a participant is in a secured domain.
struct SecuritySettings {
  std::filesystem::path keystore;  ///< empty: not secured
  std::string identity;            ///< the files in keystore/enclaves/IDENTITY

  bool enabled() const { return !keystore.empty(); }
};

/// Makes the participant that is created with `qos` a secured one: authentication, encryption and
/// access control by the plugins of Cyclone DDS. Nothing where `settings` are not enabled. Throws
/// InputError with file, reason and remedy where the files do not allow it (CheckMaterial). Shared
/// memory, which would bypass the encryption, is refused before: ApplyDomainSettings().
void SetSecurity(const SecuritySettings& settings, dds_qos_t* qos);

/// A participant as ROS 2 expects it, secured where `settings` are enabled. Throws as SetSecurity
/// does, InputError for a domain that cannot be secured, and RunError where DDS refuses.
Entity CreateParticipant(std::uint32_t domain_id, const SecuritySettings& settings);

}  // namespace palpate::dds
