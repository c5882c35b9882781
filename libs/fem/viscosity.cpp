// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/viscosity.hpp"

#include <cmath>
#include <utility>

namespace palpate::fem {

namespace {

/// g (1 - exp(-h/tau)) tau / h.
double Weight(const PronyTerm& term, double h_s) {
  return -term.g * std::expm1(-h_s / term.tau_s) * term.tau_s / h_s;
}

}  // namespace

Viscosity::Viscosity(const TetMesh& mesh, const std::vector<int>& material_of_cell,
                     std::vector<PronyTerm> prony, double stiffness_damping_s)
    : points_(mesh, material_of_cell),
      history_(mesh),
      prony_(std::move(prony)),
      stiffness_damping_s_(stiffness_damping_s),
      branch_Pa_(prony_.size()) {}

void Viscosity::Reset(const std::vector<Material>& materials, const Eigen::VectorXd& factor_of_cell,
                      const Eigen::VectorXd& x_m) {
  scale_ = 1.0;
  history_.SetZero();
  if (!active()) return;
  points_.Evaluate(materials, factor_of_cell, x_m, &elastic_Pa_);
  for (Stresses& branch_Pa : branch_Pa_) branch_Pa.setZero(6, points_.PointCount());
}

void Viscosity::Prepare(double later_s) {
  if (!active()) return;
  double now = stiffness_damping_s_ / later_s;
  for (const PronyTerm& term : prony_) now += Weight(term, later_s);
  scale_ = 1.0 + now;
  work_Pa_ = -now * elastic_Pa_;
  for (size_t k = 0; k < prony_.size(); ++k) {
    work_Pa_ += std::exp(-later_s / prony_[k].tau_s) * branch_Pa_[k];
  }
  points_.SetMatrix(work_Pa_, &history_);
}

void Viscosity::Advance(const std::vector<Material>& materials,
                        const Eigen::VectorXd& factor_of_cell, const Eigen::VectorXd& x_m,
                        double h_s) {
  if (!active()) return;
  points_.Evaluate(materials, factor_of_cell, x_m, &work_Pa_);
  for (size_t k = 0; k < prony_.size(); ++k) {
    branch_Pa_[k] = std::exp(-h_s / prony_[k].tau_s) * branch_Pa_[k] +
                    Weight(prony_[k], h_s) * (work_Pa_ - elastic_Pa_);
  }
  std::swap(elastic_Pa_, work_Pa_);
}

}  // namespace palpate::fem
