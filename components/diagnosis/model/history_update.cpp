// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/model/history_update.hpp"

#include <algorithm>
#include <cmath>

#include "components/diagnosis/model/damage.hpp"

namespace palpate::diagnosis {

namespace {

/// What of creep is left for each sample.
void Creep(const std::vector<CreepTerm>& terms, const HistoryOperator& history,
           const Simulation& simulation, std::vector<HistoryVariables>* past) {
  const auto samples = std::ssize(simulation.samples);
  for (HistoryVariables& left : *past) {
    left.scale = 0.0;
    left.stress_Pa.setZero(6, simulation.at_rest.elastic_Pa.cols());
  }
  for (const CreepTerm& term : terms) {
    const Eigen::MatrixXd& fading = history.Fading(term.tau_s);
    for (Eigen::Index s = 0; s < samples; ++s) {
      HistoryVariables& left = (*past)[static_cast<std::size_t>(s)];
      Eigen::VectorXd weights = fading.row(s).transpose();
      left.scale += term.g * weights[s];
      weights[s] = 0.0;
      AddRemembered(simulation, term.g * weights, &left.stress_Pa);
    }
  }
}

/// How much of what it holds a body remembers at most.
double StrengthOf(const ModelHypothesis& hypothesis) {
  double strength = hypothesis.mullins ? hypothesis.mullins->inverse_r : 0.0;
  for (const CreepTerm& term : hypothesis.creep) strength += std::abs(term.g);
  return strength;
}

/// The norm of all stresses that two pasts differ by, of a body that holds `elastic_Pa`, Pa.
double Difference_Pa(const HistoryVariables& a, const HistoryVariables& b, double elastic_Pa) {
  const double of_scale_Pa = std::abs(a.scale - b.scale) * elastic_Pa;
  if (a.stress_Pa.size() == 0 || b.stress_Pa.size() == 0) {
    return of_scale_Pa + double{a.stress_Pa.norm()} + double{b.stress_Pa.norm()};
  }
  return of_scale_Pa + double{(a.stress_Pa - b.stress_Pa).norm()};
}

/// The sum of all energy densities that two pasts differ by, J/m^3.
double Difference_J_m3(const HistoryVariables& a, const HistoryVariables& b,
                       const Eigen::VectorXf& energy_J_m3) {
  const auto factor = [&](const HistoryVariables& one, Eigen::Index cell) {
    return one.cell_factor.size() == 0 ? 1.0 : one.cell_factor[cell];
  };
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < energy_J_m3.size(); ++cell) {
    sum += std::abs(factor(a, cell) - factor(b, cell)) * double{energy_J_m3[cell]};
  }
  return sum;
}

}  // namespace

bool Remembers(const ModelHypothesis& hypothesis) {
  return !hypothesis.creep.empty() || hypothesis.mullins;
}

std::vector<bool> UpdateHistory(const ModelHypothesis& hypothesis, const HistoryOperator& history,
                                const Simulation& simulation, std::vector<HistoryVariables>* past) {
  constexpr double kLittle = 1e-4;
  const std::vector<HistoryVariables> before = *past;
  if (!hypothesis.creep.empty()) Creep(hypothesis.creep, history, simulation, past);
  if (hypothesis.mullins) Soften(*hypothesis.mullins, history, simulation, past);
  double most_Pa = 0.0;
  double most_J_m3 = 0.0;
  for (const SimulatedSample& sample : simulation.samples) {
    most_Pa = std::max(most_Pa, double{sample.in_the_middle.elastic_Pa.norm()});
    most_J_m3 = std::max(most_J_m3, double{sample.in_the_middle.energy_J_m3.sum()});
  }
  const double little = kLittle * StrengthOf(hypothesis);
  std::vector<bool> is_other(past->size());
  for (std::size_t s = 0; s < past->size(); ++s) {
    const Memorable& now = simulation.samples[s].in_the_middle;
    const double stress_Pa = Difference_Pa((*past)[s], before[s], double{now.elastic_Pa.norm()});
    const double energy_J_m3 = Difference_J_m3((*past)[s], before[s], now.energy_J_m3);
    is_other[s] = stress_Pa > little * most_Pa || energy_J_m3 > little * most_J_m3;
  }
  return is_other;
}

}  // namespace palpate::diagnosis
