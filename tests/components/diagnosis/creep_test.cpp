// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>

#include "components/diagnosis/forward/simulator.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

/// The beam alone, on which a small load is put after 10 s.
struct LoadedBeam {
  LoadedBeam() : body(SmallRobot()) {
    body.cables.clear();
    body.gravity_m_s2.setZero();
    recording = MakeRecording("hold", body, {{0.0, {}}, {70.0, {}}}, 0.25);
    recording.actuation.reset();
    const Eigen::Vector3d tip_m(0.095, 0.01, 0.01);
    recording.loads = {{0.0, tip_m, Eigen::Vector3d::Zero(), 0.0, {}},
                       {10.0, tip_m, {0.0, 0.0, -1e-5}, 0.0, {}}};
    experiment.recordings = {recording};
  }

  robot::RobotBody body;
  experiment::Recording recording;
  experiment::Experiment experiment;
};

TEST(Creep, OfASmallLoadIsThatOfALinearBody) {
  const LoadedBeam beam;
  const ObservedExperiment observed = Observe(beam.experiment, beam.body);
  const Simulator simulator(observed, 1);
  ModelHypothesis hypothesis = NominalHypothesis(beam.body, observed);
  const Simulation elastic = simulator.Run(hypothesis);
  ASSERT_TRUE(elastic.status.ok()) << elastic.status.message();
  for (const double g : {0.03, 0.3}) {
    constexpr double kTau_s = 10.0;
    hypothesis.creep = {{.g = g, .tau_s = kTau_s}};
    const Simulation creeping = simulator.Run(hypothesis);
    ASSERT_TRUE(creeping.status.ok()) << creeping.status.message();
    int loaded = 0;
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      const Sample& sample = observed.samples[s];
      const Eigen::Vector3d rest_m = beam.body.markers[0].point.rest_m;
      const double sagged_m = creeping.samples[s].markers_m()(2, 0) - rest_m.z();
      if (sample.t_s < 10.0) {
        EXPECT_NEAR(sagged_m, 0.0, 1e-12);
        continue;
      }
      ++loaded;
      // E (1 + g exp(-t / tau)) relaxes; under a held load it creeps with tau (1 + g).
      double share = 0.0;
      for (const double t_s : sample.frame_t_s) {
        share += (1.0 - g / (1.0 + g) * std::exp(-(t_s - 10.0) / (kTau_s * (1.0 + g)))) /
                 static_cast<double>(sample.frame_t_s.size());
      }
      const double long_m = elastic.samples[s].markers_m()(2, 0) - rest_m.z();
      // Between samples the force is taken to go linearly, which costs a few per cent of the creep.
      EXPECT_NEAR(sagged_m / long_m, share, 0.03 * g / (1.0 + g))
          << "g " << g << " at " << sample.t_s << " s";
    }
    EXPECT_GE(loaded, 4);
  }
}

TEST(Creep, RestsAsTheRobotIsWithItsDrivesAtZero) {
  robot::RobotBody body = SmallRobot();
  // Hanging upwards it would be held by the lower cable, which no actuator pulls: it holds
  // nothing, in the rests either.
  body.gravity_m_s2 *= -1.0;
  experiment::Experiment experiment;
  experiment.recordings = {MakeRecording("still", body, {{0.0, {0.0}}, {5.0, {0.0}}}, 0.5)};
  const ObservedExperiment observed = Observe(experiment, body);
  const Simulation simulation = Simulator(observed, 1).Run(NominalHypothesis(body, observed));
  ASSERT_TRUE(simulation.status.ok()) << simulation.status.message();
  const PointStresses& elastic_Pa = simulation.samples.front().in_the_middle.elastic_Pa;
  EXPECT_LT((simulation.at_rest.elastic_Pa - elastic_Pa).norm(), 1e-5F * elastic_Pa.norm());
}

/// Bent far and let go, it stays a little bent that way: the stress that it keeps has turned with
/// the material.
TEST(Creep, OfABodyThatWasHeldBentIsALittleOfThatBend) {
  constexpr double kG = 0.1;
  constexpr double kTau_s = 20.0;
  constexpr double kLetGo_s = 200.0;
  LoadedBeam beam;
  beam.recording = MakeRecording("hold", beam.body, {{0.0, {}}, {210.0, {}}}, 0.25);
  beam.recording.actuation.reset();
  const Eigen::Vector3d tip_m(0.095, 0.01, 0.01);
  beam.recording.loads = {{0.0, tip_m, {0.0, 0.25, 0.0}, 0.0, {}},
                          {kLetGo_s, tip_m, Eigen::Vector3d::Zero(), 0.0, {}}};
  beam.experiment.recordings = {beam.recording};
  const ObservedExperiment observed = Observe(beam.experiment, beam.body);
  ModelHypothesis hypothesis = NominalHypothesis(beam.body, observed);
  hypothesis.creep = {{.g = kG, .tau_s = kTau_s}};
  const Simulation creeping = Simulator(observed, 1).Run(hypothesis);
  ASSERT_TRUE(creeping.status.ok()) << creeping.status.message();
  const double rest_m = beam.body.markers[0].point.rest_m.y();
  double held_m = 0.0;
  int let_go = 0;
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const double moved_m = creeping.samples[s].markers_m()(1, 0) - rest_m;
    const double since_s = observed.samples[s].t_s - kLetGo_s;
    if (since_s < 0.0) {
      held_m = moved_m;
      continue;
    }
    ++let_go;
    // With a modulus that relaxes by g / (1 + g), the residual fades with tau (1 + g).
    const double expected = kG / (1.0 + kG) * std::exp(-since_s / (kTau_s * (1.0 + kG)));
    EXPECT_NEAR(moved_m / held_m, expected, 0.1 * expected) << since_s << " s later";
  }
  EXPECT_GE(let_go, 2);
  EXPECT_GT(held_m, 0.02) << "a bend of more than ten degrees";
}

TEST(Creep, LeavesTheInstantaneousModulusAtOnce) {
  const LoadedBeam beam;
  const ObservedExperiment observed = Observe(beam.experiment, beam.body);
  const Simulator simulator(observed, 1);
  ModelHypothesis hypothesis = NominalHypothesis(beam.body, observed);
  const Simulation elastic = simulator.Run(hypothesis);
  constexpr double kG = 0.2;
  hypothesis.creep = {{.g = kG, .tau_s = 1e5}};
  const Simulation stiff = simulator.Run(hypothesis);
  hypothesis.creep = {{.g = kG, .tau_s = 1e-3}};
  const Simulation crept = simulator.Run(hypothesis);
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    if (observed.samples[s].t_s < 10.0) continue;
    const Eigen::Matrix3Xd& long_m = elastic.samples[s].markers_m();
    const double rest_m = beam.body.markers[0].point.rest_m.z();
    EXPECT_NEAR((stiff.samples[s].markers_m()(2, 0) - rest_m) / (long_m(2, 0) - rest_m),
                1.0 / (1.0 + kG), 2e-3);
    EXPECT_NEAR((crept.samples[s].markers_m()(2, 0) - rest_m) / (long_m(2, 0) - rest_m), 1.0, 2e-3);
  }
}

}  // namespace
}  // namespace palpate::diagnosis
