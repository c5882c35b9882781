// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/simulation.hpp"
#include "components/diagnosis/surface/seen_cloud.hpp"
#include "libs/core/status.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::diagnosis {

/// Whether an experiment's tables can be used. Refuses markers that do not change (a frozen
/// camera), positions in another order than their stamps, and a recording without actuation where
/// others have it, unless it is a rest of a robot that is driven by air alone: its chambers were
/// open.
Status CheckTables(const experiment::Experiment& experiment);

/// The same of depth frames: refuses a robot that is missing in most of them, frames that do not
/// change, or in another order than their stamps.
Status CheckImages(const ObservedExperiment& observed, const SurfaceClouds& clouds);

/// The same of the measurements beside the nominal robot's simulation: refuses missing equilibria,
/// too few markers, a robot of another size.
Status CheckAgainstNominal(const ObservedExperiment& observed, const Simulation& as_built);

}  // namespace palpate::diagnosis
