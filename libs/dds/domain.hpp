// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "libs/dds/entity.hpp"

namespace palpate::dds {

/// Text of config/cyclonedds/default.xml as it was when this program was built.
std::string_view BuiltInDomainSettings();

/// CYCLONEDDS_URI, or BuiltInDomainSettings(), and where they name no interface, the one that the
/// environment variable PALPATE_INTERFACE names (name or IPv4 address).
std::string EffectiveSettings();

/// Applies BuiltInDomainSettings() to a domain of this process, unless CYCLONEDDS_URI names others
/// or the process has joined the domain already. Keep what it returns as long as anything of the
/// domain lives; nullptr: nothing was applied. To be called before the first participant of the
/// domain. `is_secured`: participants of this process have DDS Security by other settings than
/// these. Safe from any thread. Throws RunError where DDS refuses, InputError for settings of
/// CYCLONEDDS_URI that RefusalOf() refuses.
std::shared_ptr<Entity> ApplyDomainSettings(uint32_t domain_id, bool is_secured = false);

}  // namespace palpate::dds
