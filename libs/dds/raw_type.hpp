// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <string>
#include <string_view>

#include "libs/dds/entity.hpp"

struct ddsi_sertype;

namespace palpate::dds {

/// A topic whose messages stay CDR, so that a program needs no code of their type. Its endpoints
/// match all of the same topic and type name. Throws RunError where DDS refuses.
/// `has_key`: whether its type has a key, which must be as its partners have it; all instances then
/// look like one. `type`: where not null, is set to what WriteCdr() needs, for as long as the topic
/// lives.
Entity CreateRawTopic(dds_entity_t participant, const std::string& dds_topic,
                      const std::string& dds_type, bool has_key = false,
                      const ddsi_sertype** type = nullptr);

/// Writes a message that is CDR, with its header of 4 bytes. False where it is shorter than that,
/// or DDS does not take it.
[[nodiscard]] bool WriteCdr(dds_entity_t writer, const ddsi_sertype* type, std::string_view cdr);

}  // namespace palpate::dds
