// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/key_table.hpp"
#include "libs/scenario/effect.hpp"

namespace palpate::scenario {

/// The keys of scenario.yaml and of the maps in it; README.md here is made from them.
const KeyTable& ScenarioKeys();
const KeyTable& BodyKeys();
const KeyTable& BodyMaterialKeys();
const KeyTable& PronyKeys();
const KeyTable& MotionKeys();
const KeyTable& SupplyKeys();
/// Of an effect of this kind (EffectCatalogue): `id`, `where` and its parameters.
const KeyTable& EffectKeys(const EffectKind& kind);
const KeyTable& ToolKeys();
const KeyTable& CameraSpecKeys();
const KeyTable& FurtherCameraKeys();
const KeyTable& DepthNoiseKeys();
const KeyTable& StageKeys();
const KeyTable& MarkerSpecKeys();
const KeyTable& RecordingPlanKeys();
const KeyTable& CommandRowKeys();
const KeyTable& ToolPathKeys();
const KeyTable& WaypointKeys();
const KeyTable& HungWeightKeys();

}  // namespace palpate::scenario
