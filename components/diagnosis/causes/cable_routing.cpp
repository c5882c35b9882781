// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// Nobody mounts a guide so far beside its place.
constexpr double kFarthest_m = 0.02;

/// The point that the cable is pulled from sits elsewhere; the drive is zeroed with it there.
class CableRouting final : public FaultModel {
 public:
  CableRouting(const std::string& cable, int index)
      : FaultModel({"cable_routing", {"cable:" + cable}}, "place of the guide of cable " + cable,
                   {{.name = "dx_m", .tolerance = 3e-4, .fault = 4e-3, .plausible = kFarthest_m},
                    {.name = "dy_m", .tolerance = 3e-4, .fault = 4e-3, .plausible = kFarthest_m},
                    {.name = "dz_m", .tolerance = 3e-4, .fault = 4e-3, .plausible = kFarthest_m}}),
        index_(index) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.cables[static_cast<std::size_t>(index_)].pull_point_m += z;
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    robot->cables[static_cast<std::size_t>(index_)].path_m.col(0) += z;
    return true;
  }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(parameter);
    auto sum = std::make_unique<SumOfParameters>();
    sum->Add(1.0, robot::PullPointMove(index_, direction, robot::CableZero::kKept));
    if (at.observed.timeline.by_tension[static_cast<std::size_t>(index_)]) return sum;
    // Zeroed in the shape of that time, which a bent body no longer has.
    const robot::BodyCable& cable = at.hypothesis.body.cables[static_cast<std::size_t>(index_)];
    const Eigen::Vector3d last_m =
        cable.pull_point_m - cable.eyelets.front().weights.Position(at.hypothesis.assembled_m);
    Eigen::VectorXd change_m = Eigen::VectorXd::Zero(std::ssize(at.hypothesis.body.cables));
    change_m[index_] = -last_m.normalized().dot(direction);
    sum->Add(1.0, CommandChange(std::move(change_m)));
    return sum;
  }

 private:
  int index_;
};

}  // namespace

void MakeCableRouting(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  for (std::size_t c = 0; c < world.body.cables.size(); ++c) {
    causes->push_back(
        std::make_unique<CableRouting>(world.body.cables[c].name, static_cast<int>(c)));
  }
}

}  // namespace palpate::diagnosis
