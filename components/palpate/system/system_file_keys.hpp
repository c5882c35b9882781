// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/key_table.hpp"

namespace palpate::command {

/// The keys of a system file and of the maps in it.
const KeyTable& SystemFileKeys();
const KeyTable& HostKeys();
const KeyTable& ProcessKeys();
const KeyTable& RespawnKeys();
const KeyTable& StopKeys();

/// The components that a system file may name: "force_estimation" is palpate-force-estimation.
const std::vector<std::string>& ComponentNames();

/// The configurations of Cyclone DDS that a system file may name: config/cyclonedds/NAME.xml.
const std::vector<std::string>& TransportNames();

}  // namespace palpate::command
