// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

class YoungsModulusCause final : public FaultModel {
 public:
  YoungsModulusCause()
      : FaultModel({"youngs_modulus", {"body"}}, "Young's modulus of the body",
                   {{.name = "factor",
                     .nominal = 1.0,
                     .tolerance = 0.03,
                     .fault = 0.5,
                     .scale = FaultParameter::Scale::kFactor}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    for (fem::Material& material : hypothesis->body.materials) {
      material.youngs_modulus_Pa *= std::exp(z[0]);
    }
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    robot->material.youngs_modulus_Pa *= std::exp(z[0]);
    for (robot::RegionSettings& region : robot->regions) {
      if (region.youngs_modulus_Pa) *region.youngs_modulus_Pa *= std::exp(z[0]);
    }
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    auto sum = std::make_unique<SumOfParameters>();
    const auto& materials = at.model.elastic_body().materials();
    for (std::size_t k = 0; k < materials.size(); ++k) {
      sum->Add(materials[k].youngs_modulus_Pa, robot::YoungsModulus(static_cast<int>(k)));
    }
    return sum;
  }
};

}  // namespace

void MakeYoungsModulus(const CauseWorld& /*world*/, std::vector<FaultModelPtr>* causes) {
  causes->push_back(std::make_unique<YoungsModulusCause>());
}

}  // namespace palpate::diagnosis
