// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/history.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::diagnosis {
namespace {

constexpr double kTop_s = 4.0;
constexpr double kEnd_s = 8.0;
constexpr double kStep_s = 0.4;

/// Of the root of the energy, which goes up and down again.
double RootAt(double t_s) { return t_s < kTop_s ? t_s : kEnd_s - t_s; }

ObservedExperiment UpAndDown() {
  ObservedExperiment observed;
  observed.recordings.resize(1);
  observed.timeline.begin_s = {0.0};
  observed.timeline.end_s = {kEnd_s};
  for (const double begin_s : {0.0, kTop_s}) {
    Sample& sample = observed.samples.emplace_back();
    for (int k = 0; k < 10; ++k) sample.frame_t_s.push_back(begin_s + kStep_s * (k + 0.5));
    sample.t_s = begin_s + 2.0;
    sample.piece_begin_s = begin_s;
    sample.piece_end_s = begin_s + kTop_s;
    sample.still = false;
  }
  return observed;
}

HistoryInput Energy(double t_s) {
  return {PointStresses::Zero(6, 1),
          Eigen::VectorXf::Constant(1, static_cast<float>(std::pow(RootAt(t_s), 2)))};
}

Simulation SimulatedUpAndDown() {
  Simulation simulation;
  simulation.at_rest = Energy(0.0);
  for (const double begin_s : {0.0, kTop_s}) {
    SimulatedSample& sample = simulation.samples.emplace_back();
    sample.in_the_middle = Energy(begin_s + 2.0);
    sample.at_ends = {Energy(begin_s), Energy(begin_s + kTop_s)};
  }
  return simulation;
}

TEST(Damage, IsTheMeanOfWhatTheCourseOfASampleAsksFor) {
  const ObservedExperiment observed = UpAndDown();
  const HistoryOperator history(observed);
  const Simulation simulation = SimulatedUpAndDown();
  const MullinsSoftening mullins{.inverse_r = 0.4, .m_J_m3 = 9.0};
  std::vector<HistoryVariables> history_variables;
  for (int step = 0; step < 100; ++step) Soften(mullins, history, simulation, &history_variables);
  ASSERT_EQ(history_variables.size(), 2U);
  EXPECT_NEAR(history_variables[0].cell_factor[0], 1.0, 1e-6)
      << "on the way up nothing was larger before";
  double softened = 0.0;
  for (const std::size_t frame : {1U, 3U, 5U, 7U, 9U}) {
    const double root = RootAt(observed.samples[1].frame_t_s[frame]);
    softened += std::erf((std::pow(RootAt(kTop_s), 2) - root * root) / mullins.m_J_m3) / 5.0;
  }
  EXPECT_NEAR(history_variables[1].cell_factor[0], 1.0 - mullins.inverse_r * softened, 1e-5);
}

}  // namespace
}  // namespace palpate::diagnosis
