// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/cable_system.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/linalg/lu.hpp"

namespace palpate::virtual_robot {

CableSystem::CableSystem(const BenchBody& body, const Effects& effects) {
  const std::vector<std::string> names = body.CableNames();
  std::vector<Eigen::Vector3d> guide_m;
  for (const robot::BodyCable& cable : body.cables) guide_m.push_back(cable.pull_point_m);
  for (const auto* effect : OfKind(effects, "cable_routing")) {
    guide_m[At(PlaceOf(*effect, "cable", names))] +=
        Eigen::Vector3d(0.0, Value(*effect, "dy_m"), Value(*effect, "dz_m"));
  }
  int pieces = 0;
  for (size_t c = 0; c < body.cables.size(); ++c) {
    std::vector<fem::InterpolationWeights> eyelets;
    for (const fem::BodyPoint& point : body.cables[c].eyelets) eyelets.push_back(point.weights);
    Cable cable{.geometry = CableGeometry(guide_m[c], eyelets), .sliding = {}, .beyond_m = {}};
    cable.first_piece = pieces;
    cable.friction = body.cables[c].friction_coefficient;
    cable.max_tension_N = body.cables[c].max_tension_N;
    cable.geometry.Evaluate(body.assembled_m);
    cable.rest_length_m = cable.geometry.TotalLength_m();
    pieces += cable.geometry.PieceCount();
    cables_.push_back(std::move(cable));
  }
  for (const auto* effect : OfKind(effects, "cable_friction")) {
    cables_[At(PlaceOf(*effect, "cable", names))].friction += NonNegativeValue(*effect, "mu");
  }
  for (const auto* effect : OfKind(effects, "cable_elasticity")) {
    cables_[At(PlaceOf(*effect, "cable", names))].compliance_m_N +=
        1.0 / PositiveValue(*effect, "k_N_m");
  }
  for (const auto* effect : OfKind(effects, "cable_cutting")) {
    cables_[At(PlaceOf(*effect, "cable", names))].cutting_m_N +=
        NonNegativeValue(*effect, "compliance_m_N");
  }
  tension_N_ = Eigen::VectorXd::Zero(pieces);
  pulled_in_m_ = Eigen::VectorXd::Zero(CableCount());
}

fem::NodePairs CableSystem::CoupledPairs() const {
  fem::NodePairs pairs;
  for (const Cable& cable : cables_) {
    const fem::NodePairs own = cable.geometry.CoupledPairs();
    pairs.insert(pairs.end(), own.begin(), own.end());
  }
  return pairs;
}

void CableSystem::BindTo(const fem::StiffnessMatrix& stiffness) {
  for (Cable& cable : cables_) cable.geometry.BindTo(stiffness);
}

void CableSystem::Reset() {
  tension_N_.setZero();
  for (Cable& cable : cables_) {
    cable.sliding.setZero(cable.geometry.PieceCount());
    cable.beyond_m.setZero(cable.geometry.PieceCount());
  }
}

void CableSystem::Evaluate(const Eigen::VectorXd& x_m) {
  for (Cable& cable : cables_) cable.geometry.Evaluate(x_m);
}

Eigen::VectorXd CableSystem::Lengths_m() const {
  Eigen::VectorXd length_m(PieceCount());
  for (const Cable& cable : cables_) {
    for (int j = 0; j < cable.geometry.PieceCount(); ++j) {
      length_m[cable.first_piece + j] = cable.geometry.Length_m(j);
    }
  }
  return length_m;
}

void CableSystem::Gradients(Eigen::MatrixXd* nodal) const {
  nodal->setZero();
  Eigen::VectorXd column(nodal->rows());
  for (const Cable& cable : cables_) {
    for (int j = 0; j < cable.geometry.PieceCount(); ++j) {
      column.setZero();
      cable.geometry.AddGradient(j, 1.0, column);
      nodal->col(cable.first_piece + j) = column;
    }
  }
}

void CableSystem::AddForces(double factor, Eigen::VectorXd& nodal) const {
  for (const Cable& cable : cables_) {
    for (int j = 0; j < cable.geometry.PieceCount(); ++j) {
      cable.geometry.AddGradient(j, -factor * tension_N_[cable.first_piece + j], nodal);
    }
  }
}

void CableSystem::AddCurvature(fem::StiffnessMatrix& stiffness) const {
  for (const Cable& cable : cables_) {
    for (int j = 0; j < cable.geometry.PieceCount(); ++j) {
      cable.geometry.AddCurvature(j, tension_N_[cable.first_piece + j], stiffness);
    }
  }
}

double CableSystem::DriveTension_N(int cable) const {
  return tension_N_[cables_[At(cable)].first_piece];
}

double CableSystem::Sliding(const Cable& cable, int piece, double beyond_m) const {
  return cable.sliding[piece] - (beyond_m - cable.beyond_m[piece]) / kPresliding_m;
}

void CableSystem::BalanceDrive(size_t index, const Eigen::VectorXd& length_m,
                               const Eigen::MatrixXd& compliance_m_N,
                               const Eigen::VectorXd& tension_N, Balance* balance) const {
  const Cable& cable = cables_[index];
  const Eigen::Index first = cable.first_piece;
  const Eigen::Index count = cable.geometry.PieceCount();
  const double pulled_in_m = pulled_in_m_[ToIndex(index)];
  const double own_m_N =
      cable.compliance_m_N + cable.cutting_m_N * cable.geometry.SquaredEyeletForces();
  const double stiffness_N_m =
      1.0 / (compliance_m_N.block(first, first, count, count).sum() + own_m_N);
  const double excess_m = length_m.segment(first, count).sum() - own_m_N * tension_N[first] -
                          (cable.rest_length_m - pulled_in_m);
  const double trial_N = tension_N[first] + stiffness_N_m * excess_m;
  balance->slope.row(first).setZero();
  if (std::isnan(pulled_in_m) || trial_N <= 0.0 || trial_N >= cable.max_tension_N) {
    const double bound_N =
        !std::isnan(pulled_in_m) && trial_N >= cable.max_tension_N ? cable.max_tension_N : 0.0;
    balance->residual_N[first] = tension_N[first] - bound_N;
    balance->slope(first, first) = 1.0;
    return;
  }
  balance->residual_N[first] = -stiffness_N_m * excess_m;
  balance->slope.row(first) =
      stiffness_N_m * compliance_m_N.middleRows(first, count).colwise().sum();
  balance->slope(first, first) += stiffness_N_m * own_m_N;
}

void CableSystem::BalanceEyelets(size_t index, const Eigen::VectorXd& length_m,
                                 const Eigen::MatrixXd& compliance_m_N,
                                 const Eigen::VectorXd& tension_N, Balance* balance) const {
  const Cable& cable = cables_[index];
  const Eigen::Index count = cable.geometry.PieceCount();
  for (int j = 1; j < count; ++j) {
    const Eigen::Index row = cable.first_piece + j;
    const double turn = frictionless_ ? 0.0 : cable.friction * cable.geometry.TurningAngle_rad(j);
    const double beyond_m = length_m.segment(row, count - j).sum();
    const double sliding = Sliding(cable, j, beyond_m);
    const double passed = std::exp(-turn * std::clamp(sliding, -1.0, 1.0));
    balance->residual_N[row] = tension_N[row] - tension_N[row - 1] * passed;
    balance->slope.row(row).setZero();
    if (std::abs(sliding) < 1.0) {
      balance->slope.row(row) = tension_N[row - 1] * turn * passed / kPresliding_m *
                                compliance_m_N.middleRows(row, count - j).colwise().sum();
    }
    balance->slope(row, row) += 1.0;
    balance->slope(row, row - 1) -= passed;
  }
}

void CableSystem::Balanced(const Eigen::VectorXd& slack_m, const Eigen::MatrixXd& compliance_m_N,
                           const Eigen::VectorXd& tension_N, Balance* balance) const {
  const Eigen::VectorXd length_m = slack_m - compliance_m_N * tension_N;
  for (size_t c = 0; c < cables_.size(); ++c) {
    BalanceDrive(c, length_m, compliance_m_N, tension_N, balance);
    BalanceEyelets(c, length_m, compliance_m_N, tension_N, balance);
  }
}

/// Newton's method on the piecewise smooth laws; a step that does not help is shortened, once.
bool CableSystem::SolveTensions(const Eigen::VectorXd& slack_m,
                                const Eigen::MatrixXd& compliance_m_N) {
  constexpr int kIterations = 100;
  constexpr double kTolerance = 1e-11;
  if (PieceCount() == 0) return true;
  Balance balance{Eigen::VectorXd(PieceCount()), Eigen::MatrixXd(PieceCount(), PieceCount())};
  Eigen::VectorXd tension_N = tension_N_;
  Balanced(slack_m, compliance_m_N, tension_N, &balance);
  for (int k = 0; k < kIterations; ++k) {
    const double before_N = balance.residual_N.norm();
    if (!std::isfinite(before_N)) return false;
    if (before_N <= kTolerance * (1.0 + tension_N.norm())) {
      tension_N_ = tension_N;
      return true;
    }
    const Eigen::VectorXd step_N = linalg::Lu(balance.slope).Solve(balance.residual_N);
    Balanced(slack_m, compliance_m_N, tension_N - step_N, &balance);
    const bool helps = balance.residual_N.norm() < before_N;
    tension_N -= helps ? step_N : 0.5 * step_N;
    if (!helps) Balanced(slack_m, compliance_m_N, tension_N, &balance);
  }
  return false;
}

void CableSystem::Commit() {
  for (Cable& cable : cables_) {
    double beyond_m = 0.0;
    for (int j = cable.geometry.PieceCount() - 1; j >= 1; --j) {
      beyond_m += cable.geometry.Length_m(j);
      if (!frictionless_) {
        cable.sliding[j] = std::clamp(Sliding(cable, j, beyond_m), -1.0, 1.0);
      }
      cable.beyond_m[j] = beyond_m;
    }
  }
}

}  // namespace palpate::virtual_robot
