// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/robot_description.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// nu of the whole body, Young's modulus as it is.
class PoissonsRatioCause final : public FaultModel {
 public:
  explicit PoissonsRatioCause(double nominal)
      : FaultModel({"poissons_ratio", {"body"}}, "Poisson's ratio of the body",
                   {{.name = "nu",
                     .nominal = nominal,
                     .tolerance = 0.005,
                     .fault = 0.04,
                     .least = -nominal,
                     .most = robot::kLargestPoissonsRatio - nominal}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const FaultParameter& nu = parameters().front();
    for (fem::Material& material : hypothesis->body.materials) {
      material.poissons_ratio += std::clamp(z[0], nu.least, nu.most);
    }
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    robot->material.poissons_ratio += z[0];
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    auto sum = std::make_unique<SumOfParameters>();
    for (std::size_t k = 0; k < at.model.elastic_body().materials().size(); ++k) {
      sum->Add(1.0, robot::PoissonsRatio(static_cast<int>(k)));
    }
    return sum;
  }
};

}  // namespace

void MakePoissonsRatio(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  causes->push_back(std::make_unique<PoissonsRatioCause>(world.body.nominal_poissons_ratio));
}

}  // namespace palpate::diagnosis
