// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

class BaseComplianceCause final : public FaultModel {
 public:
  explicit BaseComplianceCause(const Eigen::Vector3d& middle_m)
      : FaultModel({"base_compliance", {"base"}}, "compliance of the base",
                   {{.name = "compliance_rad_Nm", .fault = 0.15, .least = 0.0}}),
        middle_m_(middle_m) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->base_compliance_rad_Nm += std::max(0.0, z[0]);
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    Eigen::Matrix<double, 6, 6> turns = Eigen::Matrix<double, 6, 6>::Zero();
    turns.topLeftCorner<3, 3>().setIdentity();
    return robot::BaseCompliance(turns, middle_m_);
  }

 private:
  Eigen::Vector3d middle_m_;
};

}  // namespace

void MakeBaseCompliance(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  causes->push_back(std::make_unique<BaseComplianceCause>(MiddleOfBase(world.body)));
}

}  // namespace palpate::diagnosis
