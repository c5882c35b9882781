// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/key_table.hpp"

namespace palpate::robot {

/// The keys of a robot file and of the maps in it: docs/robot_file.md is made from them.
const KeyTable& RobotFileKeys();
const KeyTable& MeshKeys();
const KeyTable& CreepKeys();
const KeyTable& SofteningKeys();
const KeyTable& MaterialKeys();
const KeyTable& MassKeys();
const KeyTable& FixedKeys();
const KeyTable& CableKeys();
const KeyTable& ChamberSurfaceKeys();
const KeyTable& ChamberKeys();
const KeyTable& HelixKeys();
const KeyTable& RingKeys();
const KeyTable& FibreKeys();
const KeyTable& RegionKeys();
const KeyTable& MarkerKeys();
const KeyTable& FeaturePointKeys();

}  // namespace palpate::robot
