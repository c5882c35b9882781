// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/actuator_chain.hpp"
#include "components/diagnosis/forward/sample_solver.hpp"
#include "components/diagnosis/forward/simulation.hpp"

namespace palpate::diagnosis {

/// What of a sample of a motion is simulated.
enum class Detail {
  kAllParts,  ///< as many parts of it as its bends need
  kParts,     ///< what of these stands for all, where the same cables are taut and slide still
  kMiddles,   ///< its middle; how it bends about that is taken from another simulation
};

/// The shapes of a sample and the mean of what is seen of them; begins from what `simulated`
/// was. Where shapes stand for all parts, the mean lies about them as it did there.
void SolveInParts(const Sample& sample, const std::vector<SamplePart>& parts,
                  const HistoryVariables& history_variables, Detail detail, SampleSolver* solver,
                  SimulatedSample* simulated);

}  // namespace palpate::diagnosis
