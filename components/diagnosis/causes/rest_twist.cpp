// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include <Eigen/Geometry>

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kFault_rad = 0.1;  ///< of the far end

/// The body was cast twisted about the way from the middle of its base to its own.
class RestTwist final : public FaultModel {
 public:
  RestTwist(const Eigen::Vector3d& middle_m, const Eigen::Vector3d& axis, double length_m)
      : FaultModel({"rest_twist", {"body"}}, "twist of the undeformed body",
                   {{.name = "rate_rad_m", .fault = kFault_rad / length_m}}),
        middle_m_(middle_m),
        axis_(axis) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    Eigen::Matrix3Xd& nodes_m = hypothesis->body.mesh.nodes_m;
    for (Eigen::Index node = 0; node < nodes_m.cols(); ++node) {
      if (hypothesis->body.fixed.col(node).all()) continue;
      const Eigen::Vector3d arm_m = nodes_m.col(node) - middle_m_;
      const Eigen::AngleAxisd turn(z[0] * arm_m.dot(axis_), axis_);
      const Eigen::Vector3d motion_m = turn * arm_m - arm_m;
      nodes_m.col(node) += motion_m;
      hypothesis->assembled_m.segment<3>(3 * node) += motion_m;
    }
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const Eigen::Matrix3Xd& nodes_m = at.hypothesis.body.mesh.nodes_m;
    Eigen::VectorXd mode_m = Eigen::VectorXd::Zero(nodes_m.size());
    for (Eigen::Index node = 0; node < nodes_m.cols(); ++node) {
      if (at.hypothesis.body.fixed.col(node).all()) continue;
      const Eigen::Vector3d arm_m = nodes_m.col(node) - middle_m_;
      mode_m.segment<3>(3 * node) = arm_m.dot(axis_) * axis_.cross(arm_m);
    }
    return robot::RestShapeMode(std::move(mode_m), robot::CableZero::kOfChangedShape,
                                robot::MassRule::kNodalKept);
  }

 private:
  Eigen::Vector3d middle_m_;
  Eigen::Vector3d axis_;
};

}  // namespace

void MakeRestTwist(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  const Eigen::Vector3d middle_m = MiddleOfBase(world.body);
  const Eigen::Vector3d along_m = world.body.mesh.nodes_m.rowwise().mean() - middle_m;
  if (along_m.norm() == 0.0) return;
  const Eigen::Vector3d axis = along_m.normalized();
  const double length_m =
      (axis.transpose() * (world.body.mesh.nodes_m.colwise() - middle_m)).maxCoeff();
  causes->push_back(std::make_unique<RestTwist>(middle_m, axis, length_m));
}

}  // namespace palpate::diagnosis
