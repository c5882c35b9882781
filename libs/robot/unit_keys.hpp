// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/config_node.hpp"

namespace palpate::robot {

/// `map` may hold `keys` (names that end in a unit, such as "path_m"). Throws InputError at a key
/// that is one of them in another unit ("path_mm"), and names the unit that fits.
void RefuseForeignUnits(const ConfigNode& map, const std::vector<std::string>& keys);

}  // namespace palpate::robot
