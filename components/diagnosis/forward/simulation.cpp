// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/simulation.hpp"

#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

const HistoryInput& HistoryInputOf(const Simulation& simulation, Eigen::Index column) {
  const auto samples = std::ssize(simulation.samples);
  if (column == samples) return simulation.at_rest;
  const Eigen::Index end = column - samples - 1;
  const SimulatedSample& sample = simulation.samples[At(end < 0 ? column : end / 2)];
  if (end < 0) return sample.in_the_middle;
  const HistoryInput& there = sample.at_ends[At(end % 2)];
  return there.elastic_Pa.size() > 0 ? there : sample.in_the_middle;
}

void AddHistoryStress(const Simulation& simulation, const Eigen::VectorXd& weights,
                      PointStresses* stress_Pa) {
  constexpr double kNothing = 1e-6;  // of the largest weight
  const double least = kNothing * weights.cwiseAbs().maxCoeff();
  for (Eigen::Index column = 0; column < weights.size(); ++column) {
    if (std::abs(weights[column]) <= least) continue;
    *stress_Pa +=
        static_cast<float>(weights[column]) * HistoryInputOf(simulation, column).elastic_Pa;
  }
}

}  // namespace palpate::diagnosis
