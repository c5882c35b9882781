// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/softening.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "libs/core/error.hpp"

namespace palpate::virtual_robot {

namespace {

Eigen::VectorXd Volumes_m3(const fem::TetMesh& mesh) {
  Eigen::VectorXd volume_m3(mesh.CellCount());
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const Eigen::Vector3d origin_m = mesh.nodes_m.col(mesh.cells(0, cell));
    const Eigen::Vector3d a_m = mesh.nodes_m.col(mesh.cells(1, cell)) - origin_m;
    const Eigen::Vector3d b_m = mesh.nodes_m.col(mesh.cells(2, cell)) - origin_m;
    const Eigen::Vector3d c_m = mesh.nodes_m.col(mesh.cells(3, cell)) - origin_m;
    volume_m3[cell] = a_m.cross(b_m).dot(c_m) / 6.0;
  }
  return volume_m3;
}

}  // namespace

Softening::Softening(const fem::TetMesh& mesh, const Effects& effects, double duration_s)
    : duration_s_(duration_s),
      volume_m3_(Volumes_m3(mesh)),
      damage_(Eigen::VectorXd::Ones(mesh.CellCount())),
      left_damage_(damage_),
      largest_J_m3_(Eigen::VectorXd::Zero(mesh.CellCount())),
      factor_(Eigen::VectorXd::Ones(mesh.CellCount())) {
  for (const auto* effect : OfKind(effects, "temperature")) {
    temperature_change_ += Value(*effect, "relative_E_change_at_end");
  }
  if (!(temperature_change_ > -1.0)) {
    throw InputError("effect temperature: relative_E_change_at_end must be greater than -1");
  }
  for (const auto* effect : OfKind(effects, "mullins")) {
    mullins_ = Mullins{PositiveValue(*effect, "r"), PositiveValue(*effect, "m")};
    if (!(mullins_->r > 1.0)) throw InputError("effect mullins: r must be greater than 1");
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
  double most_off = 0.0;
  Eigen::VectorXd energy_J;
  body.CellEnergies(x_m, &energy_J);
  for (Eigen::Index cell = 0; cell < energy_J.size(); ++cell) {
    const double density_J_m3 = energy_J[cell] / (factor_[cell] * volume_m3_[cell]);
    double& largest = (*largest_J_m3)[cell];
    largest = std::max(largest, density_J_m3);
    const double below = (largest - density_J_m3) / mullins_->m_J_m3;
    const double wanted = 1.0 - std::erf(below) / mullins_->r;
    // Under a given load W goes as 1 / eta^2: by so much the next state answers a change of eta.
    const double answer = 4.0 * std::numbers::inv_sqrtpi * std::exp(-below * below) * density_J_m3 /
                          (mullins_->r * mullins_->m_J_m3 * damage_[cell]);
    const double share = 1.0 / (1.0 + answer);
    most_off = std::max(most_off, std::abs(wanted - damage_[cell]));
    damage_[cell] += share * (wanted - damage_[cell]);
  }
  return most_off;
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
