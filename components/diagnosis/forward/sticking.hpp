// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/forward/actuator_chain.hpp"
#include "components/diagnosis/forward/model_hypothesis.hpp"
#include "components/diagnosis/forward/simulation.hpp"

namespace palpate::diagnosis {

/// Coulomb friction of cables in their eyelets through a whole experiment: which way each cable
/// slides in each eyelet, or what it holds there while it sticks (CableFriction::sliding). Where a
/// cable is let out again, or others move the body, it sticks until its tensions have turned round,
/// the eyelets next to the actuator first. Nothing has slid when the experiment begins. What other
/// loads or a tilted base do to it between recordings is left out.
class Sticking {
 public:
  /// It must outlive it.
  explicit Sticking(const ActuatorChain& drives) : actuators_(drives) {}

  /// Sets what slides in all `parts` [samples] of a robot as `hypothesis` has it. How far cables
  /// slide is known from `samples` that were simulated, at each time from the nearest that tells
  /// it; where none does, cables slide everywhere as their actuators last went. [samples] whether
  /// what a part has of friction (CableFriction::Signed) is another than it was by more than 1e-3.
  std::vector<bool> Follow(const ModelHypothesis& hypothesis,
                           const std::vector<SimulatedSample>& samples,
                           std::vector<std::vector<SamplePart>>* parts) const;

 private:
  Eigen::MatrixXd ThroughTime(const ModelHypothesis& hypothesis,
                              const std::vector<SimulatedSample>& samples) const;

  const ActuatorChain& actuators_;
};

}  // namespace palpate::diagnosis
