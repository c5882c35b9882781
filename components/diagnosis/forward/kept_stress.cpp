// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/kept_stress.hpp"

namespace palpate::diagnosis {

void KeptStress::Set(const fem::PointStress& points, const PointStresses& stress_Pa) {
  is_there_ = stress_Pa.size() > 0;
  if (!is_there_) return;
  if (!matrix_) matrix_.emplace(mesh_).BindTo(*stiffness_);
  points.SetMatrix(stress_Pa.cast<double>(), &*matrix_);
}

fem::ConstraintCommand KeptStress::Command() const {
  if (!is_there_) return {};
  return {.mode = fem::ConstraintCommand::Mode::kMultiplier, .value = 1.0};
}

double KeptStress::Value(const Eigen::VectorXd& x_m) const {
  return is_there_ ? 0.5 * matrix_->Quadratic(x_m) : 0.0;
}

void KeptStress::AddGradient(const Eigen::VectorXd& x_m, double factor,
                             Eigen::VectorXd& nodal) const {
  if (is_there_ && factor != 0.0) matrix_->AddProduct(x_m, factor, nodal);
}

void KeptStress::AddCurvature(const Eigen::VectorXd& /*x_m*/, double multiplier,
                              fem::StiffnessMatrix& stiffness) const {
  if (is_there_) matrix_->AddTo(multiplier, stiffness);
}

}  // namespace palpate::diagnosis
