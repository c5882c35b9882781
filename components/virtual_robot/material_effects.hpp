// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_robot/bench_body.hpp"

namespace palpate::virtual_robot {

/// What the body is made of from the start: youngs_modulus, regional_stiffness, poissons_ratio,
/// stiffening, density, viscoelastic_creep. Throws InputError.
void ApplyMaterialEffects(const Effects& effects, BenchBody* body);

}  // namespace palpate::virtual_robot
