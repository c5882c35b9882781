// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/view/picture/scene.hpp"

namespace palpate::view {

/// Throws RunError, naming the part and the number of the point, where RenderScene cannot draw.
void CheckScene(const Scene& scene);

}  // namespace palpate::view
