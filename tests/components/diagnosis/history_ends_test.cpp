// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/diagnosis/forward/simulator.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

/// A pull that is seen once, and is held then: where it ends the body holds what it holds then.
TEST(MemorableEnds, OfAPullAreWhatTheHoldAfterItHas) {
  const robot::RobotBody body = SmallRobot();
  experiment::Experiment experiment;
  experiment.recordings = {
      MakeRecording("pull", body, {{0.0, {0.0}}, {4.0, {0.006}}, {12.0, {0.006}}}, 0.25)};
  const ObservedExperiment observed = Observe(experiment, body, {.most_samples = 2});
  ASSERT_FALSE(observed.samples[0].still);
  ASSERT_TRUE(observed.samples[0].begins_piece && observed.samples[0].ends_piece);
  ASSERT_TRUE(observed.samples[1].still);
  const Simulator simulator(observed, 1);
  ModelHypothesis hypothesis = NominalHypothesis(body, observed);
  const auto expect_held = [&](const Simulation& simulation, const char* what) {
    ASSERT_TRUE(simulation.status.ok()) << simulation.status.message();
    const HistoryInput& end = simulation.samples[0].at_ends[1];
    const HistoryInput& held = simulation.samples[1].in_the_middle;
    const HistoryInput& middle = simulation.samples[0].in_the_middle;
    EXPECT_GT((middle.elastic_Pa - held.elastic_Pa).norm(), 0.4F * held.elastic_Pa.norm());
    EXPECT_LT((end.elastic_Pa - held.elastic_Pa).norm(), 0.02F * held.elastic_Pa.norm()) << what;
    EXPECT_LT((end.energy_J_m3 - held.energy_J_m3).norm(), 0.1F * held.energy_J_m3.norm()) << what;
  };
  const Simulation as_built = simulator.Run(hypothesis);
  expect_held(as_built, "from nothing");
  for (auto& material : hypothesis.body.materials) material.youngs_modulus_Pa *= 1.05;
  expect_held(simulator.Run(hypothesis, &as_built), "moved along");
}

}  // namespace
}  // namespace palpate::diagnosis
