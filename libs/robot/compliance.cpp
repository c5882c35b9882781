// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/compliance.hpp"

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::robot {

void ForceDirection::AddForce(double force_N, Eigen::VectorXd& nodal_force_N) const {
  for (size_t k = 0; k < weights.nodes.size(); ++k) {
    nodal_force_N.segment<3>(3 * weights.nodes[k]) += weights.weights[k] * force_N * direction;
  }
}

Compliance::Compliance(fem::Linearisation& linearisation, std::vector<ObservationRow> effectors)
    : linearisation_(linearisation),
      effectors_(std::move(effectors)),
      nodal_(3 * linearisation.body().NodeCount()),
      step_(linearisation.Size()) {
  SetForces({});
}

void Compliance::SetEffectors(std::vector<ObservationRow> effectors) {
  effectors_ = std::move(effectors);
  const auto e = ToIndex(effectors_.size());
  W_ea_.resize(e, W_ea_.cols());
  W_ef_.resize(e, W_ef_.cols());
  delta_e_free_.resize(e);
}

void Compliance::SetForces(std::vector<ForceDirection> forces) {
  forces_ = std::move(forces);
  const auto a = ToIndex(linearisation_.constraints().size());
  const auto f = ToIndex(forces_.size());
  const auto e = ToIndex(effectors_.size());
  directions_.resize(linearisation_.Size(), a + f);
  columns_.resize(linearisation_.Size(), 1 + a + f);
  W_ea_.resize(e, a);
  W_ef_.resize(e, f);
  W_aa_.resize(a, a);
  W_af_.resize(a, f);
  delta_e_free_.resize(e);
  delta_a_free_.resize(a);
  lambda_a_.resize(a);
  lambda_f_.resize(f);
  cable_rows_.resize(static_cast<size_t>(a));
  for (Eigen::Index k = 0; k < f; ++k) {
    nodal_.setZero();
    forces_[At(k)].AddForce(1.0, nodal_);
    linearisation_.matrix().Reduce(nodal_, directions_.col(a + k));
  }
}

void Compliance::Compute(const Eigen::VectorXd& x_m, const Eigen::VectorXd& actuator_rest_m,
                         const Eigen::VectorXd& lambda_a_N, const Eigen::VectorXd& lambda_f_N) {
  PALPATE_CHECK(lambda_a_N.size() == lambda_a_.size(), lambda_a_N.size());
  PALPATE_CHECK(lambda_f_N.size() == lambda_f_.size(), lambda_f_N.size());
  lambda_a_ = lambda_a_N;
  lambda_f_ = lambda_f_N;
  FillColumns(x_m);
  linearisation_.SolveSingle(columns_);
  ObserveColumns();
  ObserveResponse(x_m, actuator_rest_m);
}

void Compliance::ComputeChord(const Eigen::VectorXd& x_m, const Eigen::VectorXd& actuator_rest_m,
                              const Eigen::VectorXd& lambda_a_N,
                              const Eigen::VectorXd& lambda_f_N) {
  lambda_a_ = lambda_a_N;
  lambda_f_ = lambda_f_N;
  columns_.col(0) = linearisation_.residual_N();
  linearisation_.SolveSingle(columns_.col(0));
  ObserveResponse(x_m, actuator_rest_m);
}

void Compliance::Observe(const Eigen::VectorXd& x_m, const Eigen::VectorXd& actuator_rest_m) {
  ObserveColumns();
  ObserveResponse(x_m, actuator_rest_m);
}

/// The free values: where effectors and cables are, and what the residual does to them.
void Compliance::ObserveResponse(const Eigen::VectorXd& x_m,
                                 const Eigen::VectorXd& actuator_rest_m) {
  const fem::StiffnessMatrix& matrix = linearisation_.matrix();
  for (size_t e = 0; e < effectors_.size(); ++e) {
    double value = effectors_[e].Value(x_m);
    for (size_t k = 0; k < effectors_[e].nodes.size(); ++k) {
      const int free_node = matrix.FreeIndex(effectors_[e].nodes[k]);
      if (free_node < 0) continue;
      value += effectors_[e].coefficients[k].dot(columns_.col(0).segment<3>(3 * free_node));
    }
    delta_e_free_[ToIndex(e)] = value;
  }
  const auto& cables = linearisation_.constraints();
  for (Eigen::Index c = 0; c < delta_a_free_.size(); ++c) {
    delta_a_free_[c] =
        actuator_rest_m[c] - cables[At(c)]->Value(x_m) + AlongCable(c, columns_.col(0));
  }
  // The free values are those without cable and contact forces; the residual holds both.
  delta_e_free_.noalias() -= W_ea_ * lambda_a_;
  delta_e_free_.noalias() -= W_ef_ * lambda_f_;
  delta_a_free_.noalias() -= W_aa_ * lambda_a_;
  delta_a_free_.noalias() -= W_af_ * lambda_f_;
}

void Compliance::FillColumns(const Eigen::VectorXd& x_m) {
  const auto& cables = linearisation_.constraints();
  for (size_t c = 0; c < cables.size(); ++c) {
    nodal_.setZero();
    cables[c]->AddGradient(x_m, -1.0, nodal_);
    auto direction = directions_.col(ToIndex(c));
    linearisation_.matrix().Reduce(nodal_, direction);
    cable_rows_[c].clear();
    for (Eigen::Index row = 0; row < direction.size(); ++row) {
      if (direction[row] != 0.0) cable_rows_[c].push_back(row);
    }
  }
  columns_.col(0) = linearisation_.residual_N();
  columns_.rightCols(directions_.cols()) = directions_;
}

/// Row of H_a times a column, few of whose entries it touches.
double Compliance::AlongCable(Eigen::Index cable,
                              const Eigen::Ref<const Eigen::VectorXd>& column) const {
  double sum = 0.0;
  for (const Eigen::Index row : cable_rows_[At(cable)]) {
    sum += directions_(row, cable) * column[row];
  }
  return sum;
}

/// Rows of H_e and H_a times the solved columns of cables and forces.
void Compliance::ObserveColumns() {
  const Eigen::Index a = lambda_a_.size();
  const Eigen::Index f = lambda_f_.size();
  const fem::StiffnessMatrix& matrix = linearisation_.matrix();
  W_ea_.setZero();
  W_ef_.setZero();
  for (size_t e = 0; e < effectors_.size(); ++e) {
    const auto row = ToIndex(e);
    for (size_t k = 0; k < effectors_[e].nodes.size(); ++k) {
      const int free_node = matrix.FreeIndex(effectors_[e].nodes[k]);
      if (free_node < 0) continue;
      const Eigen::Vector3d& coefficient = effectors_[e].coefficients[k];
      const auto moved = columns_.middleRows<3>(3 * free_node);
      for (Eigen::Index c = 0; c < a; ++c) W_ea_(row, c) += coefficient.dot(moved.col(1 + c));
      for (Eigen::Index c = 0; c < f; ++c) W_ef_(row, c) += coefficient.dot(moved.col(1 + a + c));
    }
  }
  for (Eigen::Index i = 0; i < a; ++i) {
    for (Eigen::Index j = 0; j < a; ++j) W_aa_(i, j) = AlongCable(i, columns_.col(1 + j));
    for (Eigen::Index j = 0; j < f; ++j) W_af_(i, j) = AlongCable(i, columns_.col(1 + a + j));
  }
}

void Compliance::PrepareReciprocity() {
  const auto e = ToIndex(effectors_.size());
  const Eigen::Index a = lambda_a_.size();
  const fem::StiffnessMatrix& matrix = linearisation_.matrix();
  reciprocal_.setZero(linearisation_.Size(), e + a);
  for (size_t k = 0; k < effectors_.size(); ++k) {
    nodal_.setZero();
    for (size_t n = 0; n < effectors_[k].nodes.size(); ++n) {
      nodal_.segment<3>(3 * effectors_[k].nodes[n]) = effectors_[k].coefficients[n];
    }
    matrix.Reduce(nodal_, reciprocal_.col(ToIndex(k)));
  }
  linearisation_.SolveSingle(reciprocal_.leftCols(e));
  reciprocal_.rightCols(a) = columns_.middleCols(1, a);
}

void Compliance::ObserveByReciprocity() {
  PALPATE_CHECK(reciprocal_.cols() == W_ef_.rows() + W_af_.rows(), reciprocal_.cols());
  const fem::StiffnessMatrix& matrix = linearisation_.matrix();
  W_ef_.setZero();
  W_af_.setZero();
  for (size_t f = 0; f < forces_.size(); ++f) {
    const fem::InterpolationWeights& place = forces_[f].weights;
    for (size_t k = 0; k < place.nodes.size(); ++k) {
      const int free_node = matrix.FreeIndex(place.nodes[k]);
      if (free_node < 0) continue;
      const Eigen::Vector3d share = place.weights[k] * forces_[f].direction;
      const auto moved = reciprocal_.middleRows<3>(3 * free_node);
      W_ef_.col(ToIndex(f)).noalias() += moved.leftCols(W_ef_.rows()).transpose() * share;
      W_af_.col(ToIndex(f)).noalias() += moved.rightCols(W_af_.rows()).transpose() * share;
    }
  }
}

void Compliance::EffectorPositions(const Eigen::VectorXd& lambda_a_N,
                                   const Eigen::VectorXd& lambda_f_N,
                                   Eigen::VectorXd* delta_e_m) const {
  *delta_e_m = delta_e_free_;
  delta_e_m->noalias() += W_ea_ * lambda_a_N;
  delta_e_m->noalias() += W_ef_ * lambda_f_N;
}

void Compliance::CableDisplacements(const Eigen::VectorXd& lambda_a_N,
                                    const Eigen::VectorXd& lambda_f_N,
                                    Eigen::VectorXd* delta_a_m) const {
  *delta_a_m = delta_a_free_;
  delta_a_m->noalias() += W_aa_ * lambda_a_N;
  delta_a_m->noalias() += W_af_ * lambda_f_N;
}

void Compliance::UpdateConfiguration(const Eigen::VectorXd& lambda_a_N,
                                     const Eigen::VectorXd& lambda_f_N, double fraction,
                                     Eigen::VectorXd* x_m) {
  step_ = columns_.col(0);
  for (Eigen::Index c = 0; c < lambda_a_.size(); ++c) {
    step_ += (lambda_a_N[c] - lambda_a_[c]) * columns_.col(1 + c);
  }
  for (Eigen::Index f = 0; f < lambda_f_.size(); ++f) {
    step_ += (lambda_f_N[f] - lambda_f_[f]) * columns_.col(1 + lambda_a_.size() + f);
  }
  linearisation_.matrix().AddExpanded(step_, fraction, *x_m);
}

}  // namespace palpate::robot
