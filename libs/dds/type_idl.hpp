// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <string>

namespace palpate::dds {

/// Structure of the type of a writer, as OMG IDL, from the type information that it sends. Empty
/// where it sends none (Cyclone DDS tells none of writers of the own process), or has parts that
/// IDL of MCAP readers does not know (maps, bit sets).
std::string IdlOfEndpoint(dds_entity_t participant, dds_builtintopic_endpoint_t& endpoint);

}  // namespace palpate::dds
