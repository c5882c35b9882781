// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// Also what its gravity is larger by: weight is all that shows of both.
class Density final : public FaultModel {
 public:
  Density()
      : FaultModel({"density", {"body"}}, "density of the body",
                   {{.name = "factor",
                     .nominal = 1.0,
                     .tolerance = 0.01,
                     .fault = 0.15,
                     .scale = FaultParameter::Scale::kFactor,
                     .plausible = 0.5}}) {}  // silicones differ by less

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.node_mass_kg *= std::exp(z[0]);
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    if (robot->mass.density_kg_m3) *robot->mass.density_kg_m3 *= std::exp(z[0]);
    if (robot->mass.total_kg) *robot->mass.total_kg *= std::exp(z[0]);
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::MassFactor();
  }
};

}  // namespace

void MakeDensity(const CauseWorld& /*world*/, std::vector<FaultModelPtr>* causes) {
  causes->push_back(std::make_unique<Density>());
}

}  // namespace palpate::diagnosis
