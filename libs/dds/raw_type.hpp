// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <string>

#include "libs/dds/entity.hpp"

namespace palpate::dds {

/// A topic whose messages stay CDR, so that a program needs no code of their type. Its endpoints
/// match all of the same topic and type name. Throws RunError where DDS refuses.
/// `has_key`: whether its type has a key, which must be as its partners have it; all instances then
/// look like one.
Entity CreateRawTopic(dds_entity_t participant, const std::string& dds_topic,
                      const std::string& dds_type, bool has_key = false);

}  // namespace palpate::dds
