// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/key_table.hpp"

namespace palpate::robot {

/// The keys of a calibration file and of the maps in it; docs/experiment.md has them.
const KeyTable& CalibrationFileKeys();
const KeyTable& ModulusKeys();
const KeyTable& PoissonsRatioKeys();
const KeyTable& PoseErrorKeys();
const KeyTable& ActuatorKeys();
const KeyTable& UndeterminedKeys();
const KeyTable& CalibratedCameraKeys();

}  // namespace palpate::robot
