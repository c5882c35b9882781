// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// Capstan friction in the eyelets that a cable runs through (model/sticking.hpp); one with a knot
/// only has none.
class CableFrictionCause final : public FaultModel {
 public:
  CableFrictionCause(const std::string& cable, int index)
      : FaultModel({"cable_friction", {"cable:" + cable}}, "friction of cable " + cable,
                   {{.name = "mu", .tolerance = 0.02, .fault = 0.3, .least = 0.0}}),
        index_(index) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.cables[static_cast<std::size_t>(index_)].friction_coefficient +=
        std::max(0.0, z[0]);
  }

  /// More of it sticks for longer, which OnBody leaves out.
  bool NeedsRuns(const Eigen::VectorXd& z) const override { return z[0] > 0.05; }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    robot->cables[static_cast<std::size_t>(index_)].friction_coefficient += z[0];
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::CableFrictionCoefficient(index_);
  }

 private:
  int index_;
};

}  // namespace

void MakeCableFriction(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  for (std::size_t c = 0; c < world.body.cables.size(); ++c) {
    if (world.body.cables[c].eyelets.size() < 2) continue;
    causes->push_back(
        std::make_unique<CableFrictionCause>(world.body.cables[c].name, static_cast<int>(c)));
  }
}

}  // namespace palpate::diagnosis
