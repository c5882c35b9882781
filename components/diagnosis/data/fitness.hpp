// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/model/simulation.hpp"
#include "components/diagnosis/skin/seen_cloud.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::diagnosis {

/// Why nothing can be told from an experiment's tables, a sentence; empty: it can. Looks for
/// markers that do not change (a frozen camera), positions in another order than their stamps, and
/// a recording without actuation where others have it.
std::string WhyUnfit(const experiment::Experiment& experiment);

/// The same, of what pictures show: a robot that is not in most of them, pictures that do not
/// change (a frozen camera), or in another order than their stamps.
std::string WhyUnfit(const ObservedExperiment& observed, const SkinClouds& clouds);

/// The same, of what was measured beside what the robot file's robot would do: equilibria that do
/// not exist, too few markers, a robot of another size.
std::string WhyUnfit(const ObservedExperiment& observed, const Simulation& as_built);

}  // namespace palpate::diagnosis
