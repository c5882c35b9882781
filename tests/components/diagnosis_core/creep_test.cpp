// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>

#include "components/diagnosis/model/simulator.hpp"
#include "tests/components/diagnosis_core/small_robot.hpp"

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
  ModelDraft draft = DraftOf(beam.body, observed);
  const Simulation elastic = simulator.Run(draft);
  ASSERT_TRUE(elastic.status.ok()) << elastic.status.message();
  for (const double g : {0.03, 0.3}) {
    constexpr double kTau_s = 10.0;
    draft.creep = {{.g = g, .tau_s = kTau_s}};
    const Simulation creeping = simulator.Run(draft);
    ASSERT_TRUE(creeping.status.ok()) << creeping.status.message();
    int loaded = 0;
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      const Sample& sample = observed.samples[s];
      const Eigen::Vector3d rest_m = beam.body.markers[0].point.rest_m;
      const double sagged_m = creeping.samples[s].markers_m(2, 0) - rest_m.z();
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
      const double long_m = elastic.samples[s].markers_m(2, 0) - rest_m.z();
      // Between samples the force is taken to go linearly, which costs a few per cent of the creep.
      EXPECT_NEAR(sagged_m / long_m, share, 0.03 * g / (1.0 + g))
          << "g " << g << " at " << sample.t_s << " s";
    }
    EXPECT_GE(loaded, 4);
  }
}

TEST(Creep, RestsAsTheRobotIsWithItsDrivesAtZero) {
  robot::RobotBody body = SmallRobot();
  // Hanging upwards it would be held by the lower cable, which nobody drives: it holds nothing, in
  // the rests either.
  body.gravity_m_s2 *= -1.0;
  experiment::Experiment experiment;
  experiment.recordings = {MakeRecording("still", body, {{0.0, {0.0}}, {5.0, {0.0}}}, 0.5)};
  const ObservedExperiment observed = Observe(experiment, body);
  const Simulation simulation = Simulator(observed, 1).Run(DraftOf(body, observed));
  ASSERT_TRUE(simulation.status.ok()) << simulation.status.message();
  const Eigen::VectorXd& elastic_N = simulation.samples.front().elastic_N;
  EXPECT_LT((simulation.rest_elastic_N - elastic_N).norm(), 1e-6 * elastic_N.norm());
}

TEST(Creep, LeavesTheInstantaneousModulusAtOnce) {
  const LoadedBeam beam;
  const ObservedExperiment observed = Observe(beam.experiment, beam.body);
  const Simulator simulator(observed, 1);
  ModelDraft draft = DraftOf(beam.body, observed);
  const Simulation elastic = simulator.Run(draft);
  constexpr double kG = 0.2;
  draft.creep = {{.g = kG, .tau_s = 1e5}};
  const Simulation stiff = simulator.Run(draft);
  draft.creep = {{.g = kG, .tau_s = 1e-3}};
  const Simulation crept = simulator.Run(draft);
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    if (observed.samples[s].t_s < 10.0) continue;
    const Eigen::Matrix3Xd& long_m = elastic.samples[s].markers_m;
    const double rest_m = beam.body.markers[0].point.rest_m.z();
    EXPECT_NEAR((stiff.samples[s].markers_m(2, 0) - rest_m) / (long_m(2, 0) - rest_m),
                1.0 / (1.0 + kG), 2e-3);
    EXPECT_NEAR((crept.samples[s].markers_m(2, 0) - rest_m) / (long_m(2, 0) - rest_m), 1.0, 2e-3);
  }
}

}  // namespace
}  // namespace palpate::diagnosis
