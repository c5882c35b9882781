// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/sum_of_parameters.hpp"

#include "libs/robot/sensitivity/equilibrium_point.hpp"

namespace palpate::diagnosis {

namespace {

class CommandChangeParameter final : public robot::Parameter {
 public:
  explicit CommandChangeParameter(Eigen::VectorXd change) : change_(std::move(change)) {}

  void Describe(const robot::EquilibriumPoint& at, robot::ParameterColumn* column) const override {
    using CommandKind = robot::ActuatorCommand::Kind;
    for (Eigen::Index c = 0; c < change_.size(); ++c) {
      const CommandKind kind = at.command(static_cast<int>(c)).kind;
      if (kind == CommandKind::kDisplacement) column->commanded_length_m[c] -= change_[c];
      if (kind == CommandKind::kTension) column->commanded_tension_N[c] += change_[c];
    }
  }

 private:
  Eigen::VectorXd change_;
};

class PointForceParameter final : public robot::Parameter {
 public:
  PointForceParameter(fem::InterpolationWeights weights, const Eigen::Vector3d& force_N)
      : weights_(std::move(weights)), force_N_(force_N) {}

  void Describe(const robot::EquilibriumPoint& /*at*/,
                robot::ParameterColumn* column) const override {
    column->AddForce(weights_, force_N_);
  }

 private:
  fem::InterpolationWeights weights_;
  Eigen::Vector3d force_N_;
};

}  // namespace

void SumOfParameters::Describe(const robot::EquilibriumPoint& at,
                               robot::ParameterColumn* column) const {
  robot::ParameterColumn part;
  for (const auto& [factor, parameter] : parts_) {
    part.Reset(at.x_m().size(), column->length_m.size());
    parameter->Describe(at, &part);
    column->Add(factor, part);
  }
}

robot::ParameterPtr Scaled(double factor, robot::ParameterPtr parameter) {
  auto sum = std::make_unique<SumOfParameters>();
  sum->Add(factor, std::move(parameter));
  return sum;
}

robot::ParameterPtr CommandChange(Eigen::VectorXd change) {
  return std::make_unique<CommandChangeParameter>(std::move(change));
}

robot::ParameterPtr PointForce(fem::InterpolationWeights weights, const Eigen::Vector3d& force_N) {
  return std::make_unique<PointForceParameter>(std::move(weights), force_N);
}

}  // namespace palpate::diagnosis
