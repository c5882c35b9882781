// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/inference/selection.hpp"

namespace palpate::diagnosis {

/// Forces that act all through one recording, at the places where forces are searched, and would do
/// the residual of it: the most probable of such as are assumed to be about nothing, so that what
/// one force does is no pair of large ones, and what tolerances may do is not asked of forces. Of
/// the recording that the robot file gets most wrong, or the extended model where something is
/// unexplained. Without columns where the catalogue was without forces.
ResidualForces FindResidualForces(const ObservedExperiment& observed,
                                  const HypothesisSet& hypotheses, const Selection& selection);

}  // namespace palpate::diagnosis
