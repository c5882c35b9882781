// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/softening.hpp"

#include <algorithm>

#include "libs/core/error.hpp"

namespace palpate::virtual_robot {

Softening::Softening(const BenchBody& body, const Effects& effects, double duration_s)
    : mullins_(body.softening),
      duration_s_(duration_s),
      volume_m3_(fem::CellVolumes_m3(body.mesh)),
      damage_(Eigen::VectorXd::Ones(body.mesh.CellCount())),
      left_damage_(damage_),
      largest_J_m3_(Eigen::VectorXd::Zero(body.mesh.CellCount())),
      factor_(Eigen::VectorXd::Ones(body.mesh.CellCount())) {
  for (const auto* effect : OfKind(effects, "temperature")) {
    temperature_change_ += Value(*effect, "relative_E_change_at_end");
  }
  if (!(temperature_change_ > -1.0)) {
    throw InputError("effect temperature: relative_E_change_at_end must be greater than -1");
  }
}

void Softening::Reset(fem::ElasticBody* body, const Eigen::VectorXd& x_m) {
  warmth_ = 1.0;
  damage_.setOnes();
  largest_J_m3_.setZero();
  factor_.setOnes();
  if (!active()) return;
  body->SetCellFactors(factor_);
  if (mullins_) Damage(*body, x_m, &largest_J_m3_);
  left_damage_ = damage_;
}

double Softening::Damage(const fem::ElasticBody& body, const Eigen::VectorXd& x_m,
                         Eigen::VectorXd* largest_J_m3) {
  Eigen::VectorXd energy_J;
  body.CellEnergies(x_m, &energy_J);
  return fem::StepDamage(*mullins_, energy_J.cwiseQuotient(factor_.cwiseProduct(volume_m3_)),
                         largest_J_m3, &damage_);
}

void Softening::SetFactors(fem::ElasticBody* body) {
  factor_ = warmth_ * damage_;
  body->SetCellFactors(factor_);
}

double Softening::Approach(fem::ElasticBody* body, const Eigen::VectorXd& x_m) {
  Eigen::VectorXd largest_J_m3 = largest_J_m3_;
  const double most_off = Damage(*body, x_m, &largest_J_m3);
  SetFactors(body);
  return most_off;
}

void Softening::Restore(fem::ElasticBody* body) {
  if (!active()) return;
  damage_ = left_damage_;
  SetFactors(body);
}

void Softening::Update(fem::ElasticBody* body, const Eigen::VectorXd& x_m, double since_s) {
  if (!active()) return;
  if (mullins_) Damage(*body, x_m, &largest_J_m3_);
  left_damage_ = damage_;
  warmth_ = 1.0 + temperature_change_ * std::clamp(since_s / duration_s_, 0.0, 1.0);
  SetFactors(body);
}

}  // namespace palpate::virtual_robot
