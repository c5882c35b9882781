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
  /// m that a cable moves in an eyelet, elastically, from where it pulls neither way to where it
  /// slides: sharper laws are harder to follow and no truer of silicone.
  static constexpr double kPresliding_m = 5e-5;

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

/// What sticks and slides after a step in which each eyelet's cable would slide by `freely_m`
/// [eyelets], were friction to stay as it was at `before` [eyelets]; `slide_m` [eyelets x eyelets]:
/// by how much more per what each changes by.
Eigen::VectorXd StickOrSlide(const Eigen::VectorXd& before, const Eigen::VectorXd& freely_m,
                             const Eigen::MatrixXd& slide_m);

}  // namespace palpate::diagnosis
