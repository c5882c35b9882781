// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/model/history_operator.hpp"
#include "components/diagnosis/model/model_hypothesis.hpp"
#include "components/diagnosis/model/simulation.hpp"

namespace palpate::diagnosis {

/// Whether a robot as a draft has it remembers anything.
bool Remembers(const ModelHypothesis& hypothesis);

/// Brings `past` [samples] to what `simulation`, which had another past, leaves of creep and of
/// softening. [samples] whether that is another by more than 1e-4 of all that could be left where
/// the body holds most.
std::vector<bool> UpdateHistory(const ModelHypothesis& hypothesis, const HistoryOperator& history,
                                const Simulation& simulation, std::vector<HistoryVariables>* past);

}  // namespace palpate::diagnosis
