// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/model/simulation.hpp"

#include <cmath>

namespace palpate::diagnosis {

void AddRemembered(const Simulation& simulation, const Eigen::VectorXd& weights,
                   PointStresses* stress_Pa) {
  constexpr double kNothing = 1e-6;  // of the largest weight
  const double least = kNothing * weights.cwiseAbs().maxCoeff();
  const auto samples = std::ssize(simulation.samples);
  for (Eigen::Index s = 0; s < samples; ++s) {
    if (std::abs(weights[s]) <= least) continue;
    *stress_Pa +=
        static_cast<float>(weights[s]) * simulation.samples[static_cast<std::size_t>(s)].elastic_Pa;
  }
  if (std::abs(weights[samples]) > least) {
    *stress_Pa += static_cast<float>(weights[samples]) * simulation.rest_elastic_Pa;
  }
}

}  // namespace palpate::diagnosis
