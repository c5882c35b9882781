// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/surface/surface_matcher.hpp"
#include "components/diagnosis/surface/surface_source.hpp"
#include "libs/core/status.hpp"

namespace palpate::diagnosis {

/// Reads all depth frames and matches them with the body where `hypothesis` has it. Adds to
/// `observed` the surface measurements and the facts of the cameras. Fails where they cannot be
/// used.
Status ObserveSurface(const ModelHypothesis& hypothesis, int threads, SurfaceSource* source,
                      SurfaceMatcher* matcher, ObservedExperiment* observed);

}  // namespace palpate::diagnosis
