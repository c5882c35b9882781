// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/model/simulation.hpp"

namespace palpate::diagnosis {

/// Moves simulated markers from where they are at a sample's mean command to their mean over its
/// frames: by half their second derivative in time, from the samples of the same piece, times the
/// variance of the frames' stamps. Exact for a motion quadratic in time; a cable that tautens
/// within a window is rounded. Pieces of fewer than three samples, still ones and those with a
/// sample that failed stay as they are.
void MoveToWindowMeans(const ObservedExperiment& observed, Simulation* simulation);

}  // namespace palpate::diagnosis
