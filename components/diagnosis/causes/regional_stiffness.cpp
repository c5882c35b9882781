// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

class RegionalStiffness final : public FaultModel {
 public:
  RegionalStiffness(const std::string& region, int material)
      : FaultModel({"regional_stiffness", {"region:" + region}}, "stiffness of region " + region,
                   {{.name = "factor",
                     .nominal = 1.0,
                     .tolerance = 0.03,
                     .fault = 0.4,
                     .scale = FaultParameter::Scale::kFactor}}),
        material_(material) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.materials[static_cast<std::size_t>(material_)].youngs_modulus_Pa *=
        std::exp(z[0]);
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    robot::RegionSettings& region = robot->regions[static_cast<std::size_t>(material_) - 1];
    region.youngs_modulus_Pa =
        region.youngs_modulus_Pa.value_or(robot->material.youngs_modulus_Pa) * std::exp(z[0]);
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const auto& materials = at.model.elastic_body().materials();
    return Scaled(materials[static_cast<std::size_t>(material_)].youngs_modulus_Pa,
                  robot::YoungsModulus(material_));
  }

 private:
  int material_;
};

}  // namespace

void MakeRegionalStiffness(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  const std::vector<std::string>& regions = world.body.region_names;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    causes->push_back(std::make_unique<RegionalStiffness>(regions[k], static_cast<int>(k) + 1));
  }
}

}  // namespace palpate::diagnosis
